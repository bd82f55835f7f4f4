"""A folder whose files get their names together: a run that is given up leaves it as it was."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from umform.errors import FileProblem, InvalidValue
from umform.io.atomic import write_problem


class Staging:
    """A hidden folder where files wait for their names.

    Attributes
    ----------
    folder : Path
        Where the files are to be.
    waiting : Path
        Where they are written.
    """

    def __init__(self, folder: Path, waiting: Path) -> None:
        self.folder = folder
        self.waiting = waiting

    def commit(self, names: Sequence[str]) -> list[Path]:
        """Give files their names; one that was not written is taken away, lest an old one pass for it.

        Returns
        -------
        list of Path
            The files that are there.
        """
        targets = []
        for name in names:
            target = self.folder / name
            try:
                if (self.waiting / name).exists():
                    (self.waiting / name).replace(target)
                    targets.append(target)
                else:
                    target.unlink(missing_ok=True)
            except OSError as error:
                raise write_problem(target, error) from error
        return targets


@contextmanager
def staging(out: str | Path, names: Sequence[str]) -> Iterator[Staging]:
    """Make a folder for results, and take away what was made for nothing.

    Parameters
    ----------
    out : str or Path
        The folder.
    names : sequence of str
        Files that will be written there.

    Raises
    ------
    InvalidValue
        The name of the folder is empty.
    FileProblem
        The folder cannot be made, or nothing can be written there.
    """
    if not str(out).strip():
        raise InvalidValue(
            "the folder for the results has no name",
            where="out",
            value=repr(str(out)),
            cause="an empty word, perhaps of a variable that is not set",
            remedy="name a folder; a dot is the current one",
        )
    folder = Path(out)
    missing = [place for place in (folder, *folder.parents) if not _is_there(place)]
    waiting: Path | None = None
    try:
        waiting = _prepare(folder, names, missing[-1] if missing else folder)
        yield Staging(folder, waiting)
    except FileProblem as problem:
        if waiting is not None:
            problem.where = problem.where.replace(str(waiting), str(folder))
        raise
    finally:
        if waiting is not None:
            shutil.rmtree(waiting, ignore_errors=True)
        for place in missing:
            with suppress(OSError):  # it holds files, or was never made
                place.rmdir()


def _is_there(place: Path) -> bool:
    try:
        return place.exists()
    except OSError:  # a name that is too long, a folder that must not be looked into
        return False


def _prepare(folder: Path, names: Sequence[str], first: Path) -> Path:
    """Make the folder, from its first missing part on, and try it before time is spent on its files."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise write_problem(first, error, what="the folder cannot be made") from error
    for name in names:
        if (folder / name).is_dir():
            raise write_problem(folder / name, IsADirectoryError())
    try:
        return Path(tempfile.mkdtemp(prefix=".umform-", dir=folder)).resolve()
    except OSError as error:
        raise write_problem(folder / names[0], error) from error
