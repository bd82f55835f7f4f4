"""Lines of numbers in columns of a fixed width."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from umform.errors import FileProblem


def whole(numbers: Iterable[int], width: int) -> str:
    """Whole numbers in columns."""
    return "".join(f"{int(number):{width}d}" for number in numbers)


def real(numbers: Iterable[float], width: int) -> str:
    """Numbers in columns, with all digits that fit beside sign, point and exponent."""
    return "".join(f"{number:{width}.{width - 8}E}" for number in map(float, numbers))


def columns(line: str, width: int, count: int) -> list[str]:
    """Texts of the columns of a line."""
    return [line[k * width : (k + 1) * width].strip() for k in range(count)]


def reals(line: str, width: int, count: int) -> list[float]:
    """Numbers of the columns of a line; an empty column is zero."""
    return [float(text or 0.0) for text in columns(line, width, count)]


def blocks(path: Path, marks: str, comment: Sequence[str]) -> Iterator[tuple[str, list[str]]]:
    """Keywords of a file and their lines, without comments.

    Parameters
    ----------
    path : Path
        The file.
    marks : str
        First character of a keyword.
    comment : sequence of str
        What comment lines begin with.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise FileProblem(
            "the file of a state cannot be read",
            where=str(path),
            cause=str(error),
            remedy="a file that export_state has written, in the format that is named",
        ) from error
    keyword, lines = "", list[str]()
    for line in text.splitlines():
        if any(line.startswith(mark) for mark in comment) or not line.strip():
            continue
        if line.startswith(marks):
            if keyword:
                yield keyword, lines
            keyword, lines = line.strip(), []
        else:
            lines.append(line)
    if keyword:
        yield keyword, lines
