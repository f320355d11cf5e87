"""Networks: their data, their training, their export. The only home of torch."""
