"""Tables as Parquet, where pyarrow is installed."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Mapping, Sequence
from typing import Any

from umform.io.atomic import PendingFile


def can_write_parquet() -> bool:
    """Whether pyarrow is installed."""
    return importlib.util.find_spec("pyarrow") is not None


def write_parquet(path: str | os.PathLike[str], columns: Mapping[str, Sequence[Any]]) -> None:
    """Write named columns as a table of Parquet.

    Parameters
    ----------
    path : str or os.PathLike
        The file to write.
    columns : mapping of str to sequence
        The columns by name, all of the same length; numbers, strings or None. A column of numbers and strings
        becomes one of strings.

    Raises
    ------
    FileProblem
        The file cannot be written.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pa.table({name: pa.array(_of_one_kind(column)) for name, column in columns.items()})
    with PendingFile(path) as temporary:
        pq.write_table(table, temporary)


def _of_one_kind(column: Sequence[Any]) -> list[Any]:
    mixed = len({isinstance(value, str) for value in column if value is not None}) > 1
    return [str(value) if mixed and value is not None else value for value in column]
