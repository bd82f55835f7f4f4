"""A folder whose files appear together, and to which one run at a time writes."""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from umform.errors import FileProblem, InvalidValue
from umform.io.atomic import write_problem
from umform.io.owner import is_left_behind, mark, pid_of

#: Hidden folder for unfinished files. While it exists, the folder belongs to the run that made it.
WAITING = ".umform-run"
_OWNER = "owner"
#: Folders to which this process writes, each with its hidden folder.
_held: dict[Path, Path] = {}


class Staging:
    """A hidden folder for unfinished files.

    Attributes
    ----------
    folder : Path
        Final folder of the files.
    waiting : Path
        Hidden folder.
    named : list of Path
        The finished files.
    """

    def __init__(self, folder: Path, waiting: Path) -> None:
        self.folder = folder
        self.waiting = waiting
        self.named: list[Path] = []

    def commit(self, names: Sequence[str]) -> list[Path]:
        """Move finished files to their final names; remove an old file whose new version was not written.

        Returns
        -------
        list of Path
            The existing files.
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
        self.named += targets
        return targets

    def make_again(self) -> bool:
        """Make the folders again if they were removed; return whether they were.

        Raises
        ------
        FileProblem
            They cannot be made.
        """
        if self.waiting.is_dir():
            return False
        try:
            self.waiting.mkdir(parents=True)
        except OSError as error:
            raise write_problem(self.folder, error, what="the folder was removed during the run") from error
        return True


@contextmanager
def staging(out: str | Path, names: Sequence[str]) -> Iterator[Staging]:
    """Make a folder for results and exclude other runs; remove it if it stays empty.

    In a folder that this process already holds, files have a separate hidden folder.

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
        The folder cannot be made or written, or another run is writing there.
    """
    check_name(out)
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
            _held.pop(waiting.parent, None)
            shutil.rmtree(waiting, ignore_errors=True)
        for place in missing:
            with suppress(OSError):  # it contains files, or was never made
                place.rmdir()


def check_name(out: str | Path) -> None:
    """Reject an invalid folder name.

    Raises
    ------
    InvalidValue
    """
    if not str(out).strip():
        raise InvalidValue(
            "the folder for the results has no name",
            where="out",
            value=repr(str(out)),
            cause="an empty word, perhaps of a variable that is not set",
            remedy="name a folder; a dot is the current one",
        )


def is_taken(folder: Path) -> bool:
    """Whether another run is writing to a folder."""
    waiting = folder / WAITING
    return waiting.is_dir() and folder.resolve() not in _held and not _is_left_behind(waiting)


def _is_left_behind(waiting: Path) -> bool:
    """Whether a run was killed here."""
    owner = _owner(waiting)  # this process does not hold the folder: its own number means another one
    return owner == mark() or is_left_behind(waiting, owner)


def _is_there(place: Path) -> bool:
    try:
        return place.exists()
    except OSError:  # a name that is too long, a folder that cannot be read
        return False


def _prepare(folder: Path, names: Sequence[str], first: Path) -> Path:
    """Make the folder, including missing parents, and test that it is writable before the run."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise write_problem(first, error, what="the folder cannot be made") from error
    for name in names:
        if (folder / name).is_dir():
            raise write_problem(folder / name, IsADirectoryError())
    folder = folder.resolve()
    try:
        if folder in _held:
            return Path(tempfile.mkdtemp(dir=_held[folder]))
        _remove_left_behind(folder)
        waiting = folder / WAITING
        waiting.mkdir()
        _held[folder] = waiting
        (waiting / _OWNER).write_text(mark(), encoding="utf-8")
    except FileExistsError as error:
        raise _taken(folder) from error
    except OSError as error:
        if folder in _held:
            shutil.rmtree(_held.pop(folder), ignore_errors=True)
        raise write_problem(folder / names[0], error) from error
    return waiting


def _remove_left_behind(folder: Path) -> None:
    """Remove the remains of a killed run; of two concurrent runs only one succeeds."""
    waiting = folder / WAITING
    if waiting.is_dir() and _is_left_behind(waiting):
        with suppress(OSError):
            waiting.rename(folder / f"{WAITING}-{mark()}")
            shutil.rmtree(folder / f"{WAITING}-{mark()}", ignore_errors=True)


def _owner(waiting: Path) -> str:
    """Mark of the process that writes to a folder; empty if unknown."""
    try:
        return (waiting / _OWNER).read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""


def _taken(folder: Path) -> FileProblem:
    waiting = folder / WAITING
    owner = _owner(waiting)
    since = ""
    with suppress(OSError):
        since = time.strftime(", since %Y-%m-%d %H:%M:%S", time.localtime((waiting / _OWNER).stat().st_mtime))
    return FileProblem(
        "another run is writing to this folder",
        where=str(folder),
        value=f"process {pid_of(owner)} on {owner.rpartition('-')[0]}{since}" if owner else None,
        cause="two runs would mix their files",
        remedy=f"wait for its end, or choose another folder; if there is no such run, remove {waiting}",
    )
