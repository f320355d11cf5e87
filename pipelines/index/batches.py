"""A Parquet file's rows, in batches: a long word that is repeated takes it no bytes."""

from typing import Final

import pyarrow as pa
import pyarrow.parquet as pq

from pipelines import bounded

BATCH: Final = 1000  # rows


def decoded(file: pq.ParquetFile) -> pa.Table:
    """Read a table bit by bit: a long word that is repeated takes a file no bytes.

    Raises:
        OSError: if it has more bytes than are read.
    """
    batches, size = [], 0
    for batch in file.iter_batches(BATCH):
        plain = [
            one.dictionary_decode() if pa.types.is_dictionary(one.type) else one
            for one in batch.columns
        ]
        size += sum(one.nbytes for one in plain)
        bounded.fits(size, bounded.TABLE_BYTES, "")
        batches.append(plain)
    if not batches:
        return file.read()
    columns = [pa.chunked_array(parts) for parts in zip(*batches, strict=True)]
    table = pa.Table.from_arrays(columns, file.schema_arrow.names)
    return table.replace_schema_metadata(file.schema_arrow.metadata)
