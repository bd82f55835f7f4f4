"""Files that are written atomically: complete or not at all."""

from __future__ import annotations

import errno
import io
import os
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from umform.errors import FileProblem
from umform.io.owner import is_left_behind, mark


class PendingFile:
    r"""A file that gets its name only once it is complete.

    As a context manager it gives the path of an empty temporary file in the directory of the target. At the
    regular end of the block the temporary file is flushed to the disk and renamed to the target in one step;
    after an exception it is removed, and a target that existed before stays as it was.

    Parameters
    ----------
    path : str or os.PathLike
        The target. A symbolic link is followed.

    Attributes
    ----------
    path : pathlib.Path
        The target.
    temporary : pathlib.Path
        The temporary file, hidden, with the suffix of the target.

    Raises
    ------
    FileProblem
        The directory is missing or not writable, the target is a directory, or writing failed.

    Examples
    --------
    >>> with PendingFile("table.csv") as temporary:  # doctest: +SKIP
    ...     temporary.write_text("time,force\n")
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path).resolve()
        name = f"{_before(self.path)}{mark()}.{os.urandom(4).hex()}{self.path.suffix}"
        self.temporary = self.path.with_name(name)

    def __enter__(self) -> Path:
        try:
            if self.path.is_dir():
                raise IsADirectoryError(str(self.path))
            self.temporary.touch(exist_ok=False)
        except OSError as error:
            raise write_problem(self.path, error) from error
        return self.temporary

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            try:
                self.commit()
            except FileProblem:
                self.discard()
                raise
            return
        self.discard()
        if isinstance(error, OSError) and not isinstance(error, FileProblem):
            raise write_problem(self.path, error) from error

    def commit(self) -> None:
        """Flush the temporary file to the disk and give it the name of the target.

        Raises
        ------
        FileProblem
            The temporary file cannot be flushed or renamed; it stays where it is.
        """
        try:
            with self.temporary.open("rb+") as file:
                os.fsync(file.fileno())
            self.temporary.replace(self.path)
        except OSError as error:
            raise write_problem(self.path, error) from error

    def discard(self) -> None:
        """Remove the temporary file; the target stays as it was."""
        self.temporary.unlink(missing_ok=True)


def write_text(path: str | os.PathLike[str], text: str) -> Path:
    r"""Write a text file, complete or not at all; its lines end with \n on all systems."""
    with PendingFile(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return Path(path)


def remove_left_behind(path: str | os.PathLike[str]) -> None:
    """Remove the temporary files of a target that killed processes of this machine have left.

    Parameters
    ----------
    path : str or os.PathLike
        The target; it stays.
    """
    target = Path(path).resolve()
    before, after = _before(target), target.suffix
    with suppress(OSError):  # no folder, or it cannot be read
        for file in target.parent.iterdir():
            if not (file.name.startswith(before) and file.name.endswith(after)):
                continue
            owner = file.name[len(before) : len(file.name) - len(after)].rpartition(".")[0]
            if owner and owner != mark() and is_left_behind(file, owner):
                file.unlink(missing_ok=True)


def _before(target: Path) -> str:
    """Prefix of the names of the temporary files of a target."""
    return f".{target.stem}."


#: Errors of the operating system that do not depend on the path alone: cause and remedy.
_SYSTEM = {
    errno.ENOSPC: ("the disk is full", "free some space, or choose another disk"),
    errno.EDQUOT: ("your share of the disk is used up", "free some space, or choose another disk"),
    errno.EROFS: ("the disk can only be read", "choose a directory that you may write to"),
    errno.ENAMETOOLONG: ("the name is too long", "shorten it"),
}


def write_problem(path: Path, error: OSError, what: str = "the file cannot be written") -> FileProblem:
    """Say why a file cannot be written.

    Parameters
    ----------
    path : pathlib.Path
        The target.
    error : OSError
        Error of the operating system.
    what : str, optional
        What is wrong, in one sentence.

    Returns
    -------
    FileProblem
        The error to raise, with cause and remedy.
    """
    place = _nearest(path)
    if isinstance(error, FileNotFoundError) and place == path.parent:
        cause = f"{place} takes no new files: it is a directory of the system, or was removed meanwhile"
        remedy = "choose another path"
    elif isinstance(error, FileNotFoundError):
        cause = f"the directory {path.parent} does not exist"
        remedy = "create the directory or choose another path"
    elif isinstance(error, NotADirectoryError):
        cause = f"{place} is a file, not a directory"
        remedy = "choose another path"
    elif isinstance(error, FileExistsError):
        cause = "there is a file of this name"
        remedy = "choose another name, or move the file away"
    elif isinstance(error, PermissionError):
        cause = f"no permission to write in {place}"
        remedy = "choose a directory that you may write to"
    elif isinstance(error, IsADirectoryError):
        cause = "there is a directory of this name"
        remedy = "add a file name to the path, or choose another name"
    else:
        known = _SYSTEM.get(error.errno or 0)
        said = error.strerror or str(error) or type(error).__name__
        cause = f"{known[0]} ({said})" if known else said
        remedy = known[1] if known else "check the disk, or choose another path"
    return FileProblem(what, where=str(path), cause=cause, remedy=remedy)


def _nearest(path: Path) -> Path:
    """The nearest existing parent directory of a path."""
    for place in path.parents:
        try:
            if place.exists():
                return place
        except OSError:  # it cannot be read
            continue
    return path.parent


class UntilDiskFull(io.FileIO):
    """A file that drops all data after the first failed write.

    HDF5 cannot forget a step that did not fit on the disk: on closing it writes the remaining data, and damages the
    file. With the data dropped, the file stays as of the last flush, with all previous steps.
    """

    full = False

    def write(self, data: Any) -> int:
        """Write all of the data, or drop it if an earlier write failed."""
        rest = memoryview(data).cast("B")
        size = rest.nbytes
        try:
            while rest and not self.full:
                rest = rest[super().write(rest) :]
        except OSError:
            self.full = True
            raise
        return size

    def truncate(self, size: int | None = None) -> int:
        """Change the size of the file, unless a write failed."""
        return self.tell() if self.full else super().truncate(size)
