"""A store of results: small JSON files, each named by a digest of everything that determines it."""

from __future__ import annotations

import hashlib
import json
import logging
import math
import os
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import umform
from umform.errors import FileProblem
from umform.io.atomic import write_problem, write_text

log = logging.getLogger("umform")
#: Environment variable with the folder of the store.
VARIABLE = "UMFORM_STORE"
#: Version of the layout of an entry.
_LAYOUT = 1
#: Age in seconds from which on an unfinished file has no process that writes it.
_ABANDONED = 3600.0


def store_folder() -> Path:
    """The folder of the store: that of ``UMFORM_STORE``, or ``umform/store`` in the cache folder of the user."""
    chosen = os.environ.get(VARIABLE)
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        cache = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        cache = Path.home() / "Library" / "Caches"
    else:
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return cache / "umform" / "store"


def key_of(kind: str, version: int, text: str) -> str:
    """Name of an entry.

    Parameters
    ----------
    kind : str
        What it is, such as "bend".
    version : int
        Version of what is computed: it changes with any change of the code that changes a result.
    text : str
        All input; see :func:`umform.analysis.run.fingerprint.text`.
    """
    whole = "\n".join([kind, str(version), umform.__version__, text])
    return hashlib.sha256(whole.encode()).hexdigest()[:40]


@dataclass(frozen=True)
class Entry:
    """A stored result.

    Attributes
    ----------
    key : str
        Its name.
    kind : str
        What it is.
    about : dict
        What it was computed from, for people.
    value : dict
        The numbers; NaN where they are not defined.
    version : str
        Version of umform that computed it.
    current : bool
        Whether this version of umform would find it.
    path : Path
        Its file.
    """

    key: str
    kind: str
    about: dict[str, Any]
    value: dict[str, Any]
    version: str
    current: bool
    path: Path


class Store:
    """Results by their keys. Processes may read and write at the same time: an entry is complete or not there.

    Parameters
    ----------
    folder : str or Path, optional
        Default: :func:`store_folder`.

    Examples
    --------
    >>> import tempfile
    >>> store = Store(tempfile.mkdtemp())
    >>> key = key_of("sum", 1, "1 + 1")
    >>> store.put(key, "sum", {"of": "1 + 1"}, {"is": 2.0}, version=1).name == f"{key[2:]}.json"
    True
    >>> store.get(key).value
    {'is': 2.0}
    """

    #: Versions of the kinds of entries, for `prune`.
    versions: dict[str, int] = {}

    def __init__(self, folder: str | Path | None = None) -> None:
        self.folder = store_folder() if folder is None else Path(folder)

    def path(self, key: str) -> Path:
        """File of an entry."""
        return self.folder / key[:2] / f"{key[2:]}.json"

    def get(self, key: str) -> Entry | None:
        """An entry, or None if it is missing or damaged; a damaged one is logged as a warning."""
        path = self.path(key)
        try:
            return _read(key, path)
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError) as error:
            log.warning("the stored result %s cannot be read and is computed again: %s", path, error)
            return None

    def put(self, key: str, kind: str, about: Mapping[str, Any], value: Mapping[str, Any], version: int) -> Path:
        """Write an entry.

        Parameters
        ----------
        key, kind : str
            See :func:`key_of`.
        about, value : mapping
            Data of JSON; NaN is allowed.
        version : int
            As in the key.

        Raises
        ------
        FileProblem
            The folder cannot be written.
        """
        self.prepare()
        path = self.path(key)
        body = {"kind": kind, "made_by": [umform.__version__, version], "about": _plain(about), "value": _plain(value)}
        text = json.dumps({"layout": _LAYOUT, "check": _check(body), **body}, indent=1, allow_nan=False)
        try:
            path.parent.mkdir(exist_ok=True)
        except OSError as error:
            raise self._unwritable(error) from error
        return write_text(path, text + "\n")

    def prepare(self) -> None:
        """Make the folder.

        Raises
        ------
        FileProblem
            It cannot be made.
        """
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise self._unwritable(error) from error

    def _unwritable(self, error: OSError) -> FileProblem:
        problem = write_problem(self.folder / "entry", error, "the store of results cannot be written")
        problem.where, problem.remedy = str(self.folder), f"another folder: --store FOLDER, or the variable {VARIABLE}"
        return problem

    def entries(self, kind: str | None = None) -> Iterator[Entry]:
        """All readable entries, of one kind."""
        for path in self._files():
            try:
                entry = _read(path.parent.name + path.stem, path)
            except (OSError, ValueError, KeyError, TypeError):
                continue
            if kind is None or entry.kind == kind:
                yield entry

    def prune(self, older_than: float | None = None, *, everything: bool = False) -> int:
        """Remove entries that cannot be read or that another version of umform has computed.

        Parameters
        ----------
        older_than : float, optional
            Remove also those older than this number of days.
        everything : bool
            Remove all entries.

        Returns
        -------
        int
            Number of removed files.
        """
        now, removed = time.time(), 0
        for path in self._files():
            try:
                entry = None if everything else _read(path.parent.name + path.stem, path)
                old = older_than is not None and now - path.stat().st_mtime > 86400.0 * older_than
                keep = entry is not None and entry.current and not old
            except (OSError, ValueError, KeyError, TypeError):
                keep = False
            if not keep:
                path.unlink(missing_ok=True)
                removed += 1
        for path in self.folder.glob("[0-9a-f][0-9a-f]/.*.json"):  # what killed processes have left
            with suppress(OSError):
                if now - path.stat().st_mtime > _ABANDONED:
                    path.unlink()
        return removed

    def _files(self) -> list[Path]:
        return sorted(path for path in self.folder.glob("[0-9a-f][0-9a-f]/*.json") if not path.name.startswith("."))


def _read(key: str, path: Path) -> Entry:
    data = json.loads(path.read_text(encoding="utf-8"))
    body = {name: data[name] for name in ("kind", "made_by", "about", "value")}
    if data["layout"] != _LAYOUT or data["check"] != _check(body):
        raise ValueError("it is damaged, or of another layout")
    made_by, version = data["made_by"]
    current = made_by == umform.__version__ and version == Store.versions.get(data["kind"], version)
    value = {name: math.nan if number is None else number for name, number in data["value"].items()}
    return Entry(key, data["kind"], data["about"], value, made_by, current, path)


def _check(body: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(body, sort_keys=True).encode()).hexdigest()[:16]


def _plain(data: Any) -> Any:
    """Data of JSON, None for NaN."""
    if isinstance(data, Mapping):
        return {str(name): _plain(value) for name, value in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(value) for value in data]
    return None if isinstance(data, float) and math.isnan(data) else data
