"""A deck: one TOML file that describes a problem."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from umform.analysis.run import Result
from umform.errors import InvalidValue, UmformError
from umform.mesh import Mesh
from umform.model import Model
from umform.model.model import sent_as
from umform.model.transfer.rigid_motion import RigidMotion
from umform.problem.building import build, sheet
from umform.problem.contents import Contents
from umform.problem.deck_text import deck_text, plain
from umform.problem.errors import DeckError, DeckKey
from umform.problem.keys import written_out
from umform.problem.prepared import Prepared
from umform.problem.previous_operation import TAKEN, merged
from umform.problem.profiles import as_written
from umform.problem.reading import Unfit, read
from umform.problem.references import unknown_names
from umform.problem.source import Source, change, parse, read_file, within
from umform.spec import Scalar, scalars


@dataclass(frozen=True, repr=False)
class Problem:
    """A deck with valid keys, types and names.

    Attributes
    ----------
    contents : Contents
        Its content.
    source : Source
        Its text, and the place of each key.
    before : Problem or None
        The deck of the previous operation.
    start : Result or None
        The run of the previous operation, if it is in memory.
    """

    contents: Contents
    source: Source
    before: Problem | None = None
    start: Result | None = None

    def __repr__(self) -> str:
        """Short: its tables are in `toml`."""
        return f"Problem({self.contents.title or self.source.name!r}, {len(self.contents.steps)} steps)"

    @classmethod
    def read(
        cls,
        text: str,
        name: str = "deck",
        folder: str | Path = ".",
        changes: Mapping[str, Any] | None = None,
        trust: bool = False,
    ) -> Problem:
        """Read a deck from its text.

        Parameters
        ----------
        text : str
            TOML.
        name : str
            For messages.
        folder : str or Path
            Folder of the files that it names.
        changes : mapping of str to object, optional
            Other values of some keys: ``{"steps.0.increments": 3}``.
        trust : bool
            Whether classes that it names as ``module:Class`` may be imported: they are code.

        Raises
        ------
        DeckError
            With all mistakes in it.
        """

        def default(path: str) -> list[Any] | None:
            return cls._read(parse(text, name, Path(folder), trust=trust))._array(path)

        return cls._read(parse(text, name, Path(folder), changes, trust, default))

    @classmethod
    def _read(cls, source: Source, after: tuple[Path, ...] = ()) -> Problem:
        """Read a deck of a previous operation of the decks ``after``."""
        before = _before(source, after)
        if before is not None:
            source = merged(source, before.source)
        errors: list[UmformError] = [*_idle_trim(source)]
        contents: Contents | None = None
        try:
            contents = read(Contents, source.data, source.context)
        except Unfit:
            from umform.problem.messages import checked  # pydantic takes long to import

            contents, wrong = checked(source)
            errors += wrong
        errors += unknown_names(source)
        if errors or contents is None:
            raise DeckError(errors)
        return cls(contents, source, before)

    @classmethod
    def of(cls, tables: Mapping[str, Any], remarks: Iterable[str] = (), start: Result | None = None) -> Problem:
        """A problem from tables of a program; errors are raised as they are.

        Parameters
        ----------
        tables : mapping
            What a deck holds; arrays may be tuples, keys with the value None are left out.
        remarks : iterable of str
            Paragraphs at the head of its text.
        start : Result, optional
            The run of the previous operation of the same sheet, from whose last state this one starts.

        Raises
        ------
        DeckError
            If a key does not exist, or its value has another type.
        """
        data = plain(tables)
        source = Source(data.get("title", "problem"), Path(), "", data, {}, {}, tuple(remarks), made=True, trust=True)
        return replace(cls._read(source), start=start)

    def with_(self, changes: Mapping[str, Any], *, same_topology: bool = False) -> Problem:
        """The problem with other values at some paths; the mesh follows.

        Parameters
        ----------
        changes : mapping of str to object
            Values by path, such as ``{"tools.die.radius": 2.1}``; see :meth:`paths`. A path into the law of a sheet
            metal of the library writes the law out.
        same_topology : bool
            Refuse a change that gives another number of nodes or other elements.

        Raises
        ------
        DeckError
            With all mistakes.
        InvalidValue
            The mesh has another topology, and must not.
        """
        source = self.source
        if source.made:
            data = deepcopy(source.data)
            change(data, changes, self._array)
            changed = replace(type(self)._read(replace(source, data=data)), start=self.start)
        else:
            earlier = {key: value for key, value in source.changes.items() if not within(key, changes)}
            changed = type(self).read(source.text, source.name, source.folder, earlier | dict(changes), source.trust)
        if same_topology:
            _refuse_other_topology(self.sheet().mesh, changed.sheet().mesh, changes)
        return changed

    def at(self, folder: Path) -> Problem:
        """The same, with the files that it names in another folder, or with an absolute path."""
        return replace(self, source=replace(self.source, folder=folder))

    def paths(self) -> list[Scalar]:
        """All numbers of the problem that can be changed: path, value, unit, sentence; defaults included.

        Those of the sheet of an operation before cannot.
        """
        material = self.source.data["material"]
        law = material if self.before is not None else written_out(material)
        named = self if law is material else self.with_({"material": law})
        found = as_written(scalars(named.contents), named.source.data)
        fixed = ("output", *(TAKEN if self.before is not None else ()))
        return [one for one in found if one.path.partition(".")[0] not in fixed]

    def _array(self, path: str) -> list[Any] | None:
        """The numbers of an array; None if there are none at a path."""
        return [one.value for one in self.paths() if one.path.rpartition(".")[0] == path] or None

    @property
    def placed(self) -> RigidMotion | None:
        """Motion of the part from the place of its blank, by the placements of this deck and of those before."""
        first = None if self.before is None else self.before.placed
        own = None if self.contents.placement is None else self.contents.placement.motion
        return own.after(first) if own and first else own or first

    def toml(self, before: Mapping[str, str] | None = None, remarks: Iterable[str] = ()) -> str:
        """Text of the deck; that of a file as it was read, unless it was changed or has remarks.

        Parameters
        ----------
        before : mapping, optional
            Names of the files ``deck`` and ``state`` of the previous operation, for a problem that starts from a run.
        remarks : iterable of str
            Paragraphs at its head.

        Raises
        ------
        InvalidValue
            A value that was made by a program has no notation in TOML, or the files of the start have no name.
        """
        source, told = self.source, [*self.source.remarks, *remarks]
        if self.start is None:
            return deck_text(self._own, told) if source.made or source.changes or told else source.text
        if before is None:
            raise InvalidValue(
                "a deck names the files of the operation before",
                where="before",
                cause="a problem that starts from a run in memory",
                remedy='before={"deck": "first.toml", "state": "first/state.h5"}',
            )
        return deck_text({"before": dict(before)} | self._own, told)

    @property
    def _own(self) -> dict[str, Any]:
        """Its data without those of the operation before."""
        taken = TAKEN if self.before is not None or self.start is not None else ()
        return {key: value for key, value in self.source.data.items() if key not in taken}

    def build(self, solver: str | None = None) -> Prepared:
        """Build the model, its controls and its steps.

        Parameters
        ----------
        solver : str, optional
            Another sparse solver than that of the deck.

        Raises
        ------
        DeckError
            With all mistakes.
        """
        prepared = build(self.contents, self.source, solver, self.before, self.start)
        sent_as(prepared.model, self)
        return prepared

    def sheet(self) -> Model:
        """The model without tools and supports, before the first step.

        Raises
        ------
        DeckError
            With all mistakes.
        """
        return sheet(self.contents, self.source, self.before, self.start)


def _refuse_other_topology(before: Mesh, after: Mesh, changes: Mapping[str, Any]) -> None:
    if np.array_equal(before.connectivity, after.connectivity) and len(before.points) == len(after.points):
        return
    raise InvalidValue(
        "the mesh has another topology with this value",
        where=", ".join(changes),
        value=f"{len(after.connectivity)} elements in place of {len(before.connectivity)}",
        cause="the number of elements follows from it",
        remedy="a smaller change, or a mesh whose numbers of elements are given",
    )


def _idle_trim(source: Source) -> list[DeckKey]:
    """The error of a deck with a trim but without a previous operation."""
    if "before" in source.data or not source.data.get("trim"):
        return []
    return [
        DeckKey(
            "a deck trims the part of the operation before, and names none",
            where=source.place(("trim",)),
            cause="the table before is missing",
            remedy="[before] with deck, state and control",
        )
    ]


def _before(source: Source, after: tuple[Path, ...]) -> Problem | None:
    """The deck of the previous operation, if the deck names one."""
    table = source.data.get("before")
    named = table.get("deck") if isinstance(table, dict) else None
    if not isinstance(named, str):
        return None
    path, chain = source.folder / named, (*after, (source.folder / source.name).resolve())
    if path.resolve() in chain:
        raise DeckError(
            [
                DeckKey(
                    "a deck cannot be the operation before itself",
                    where=source.place(("before", "deck")),
                    value=named,
                    cause="decks that name each other as the operation before" if len(chain) > 1 else "",
                    remedy="the deck whose run comes first",
                )
            ]
        )
    return Problem._read(parse(read_file(path), path.name, path.parent, trust=source.trust), chain)


def load(path: str | Path, changes: Mapping[str, Any] | None = None, trust: bool = False) -> Problem:
    """Read a deck from a file.

    Parameters
    ----------
    path : str or Path
        The file.
    changes : mapping of str to object, optional
        Other values of some keys: ``{"steps.0.increments": 3}``.
    trust : bool
        Whether classes that it names as ``module:Class`` may be imported: they are code.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    DeckError
        With all mistakes in the deck.

    Examples
    --------
    >>> from umform.problem import load
    >>> result = load("deck.toml").build().solve()  # doctest: +SKIP
    """
    path = Path(path)
    return Problem.read(read_file(path), path.name, path.parent, changes, trust)
