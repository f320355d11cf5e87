"""`python -m pipelines.cli` is `nostalgin`."""

from pipelines.cli import main

main()
