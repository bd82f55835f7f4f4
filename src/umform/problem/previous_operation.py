"""The previous operation: its deck and final state, and cuts of the part.

A deck with a table ``before`` takes mesh, material and element from the named deck, and the state from a file that a
run of that deck has written.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import field, replace
from pathlib import Path as File
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from umform.errors import FileProblem, InvalidValue
from umform.io.trees import read_tree, write_tree
from umform.model import Model, Snapshot
from umform.model.contact import Contact
from umform.model.contact.kept_history import KeptContact
from umform.model.contact.sheets import SheetContact
from umform.model.transfer.rigid_motion import RigidMotion
from umform.problem.errors import DeckError, DeckKey
from umform.problem.notes import Field
from umform.problem.parts import Name, Part, Vector
from umform.problem.profiles import ProfilePart, profile_of
from umform.problem.source import Source

if TYPE_CHECKING:
    from umform.model.transfer.trim import Trim

#: Tables of the previous deck.
TAKEN = ("mesh", "material", "element")
STATE_KIND = "state of a umform model"


class Before(Part):
    """The previous operation."""

    deck: Annotated[str, Field(min_length=1)]
    """Its deck; path from the folder of this deck."""
    state: Annotated[str, Field(min_length=1)]
    """The file state.h5 of its run, written with state = true under output; path from the folder of this deck."""
    control: Name | None = None
    """Name of the control, of value 1, of the unbalanced forces: those of tools and supports of that operation, and of
    removed metal. Steps move it to 0. Without it the part was released, and what is left over acts at once."""
    keep: list[Name] = field(default_factory=list)
    """Names of contacts of that deck and of this one whose points keep friction and multipliers, and a penalty that was
    estimated: tools that stay where they stood, and sheets that touch."""

    def restore(self, model: Model, folder: File, tables: Mapping[str, Any]) -> None:
        """Restore a model, built from the data of a deck, to the state.

        Raises
        ------
        FileProblem
            If the file cannot be read, or is of another model.
        """
        path = folder / self.state
        if not path.is_file():
            raise FileProblem(
                "the deck before has left no state",
                where=str(path),
                cause="it was not run yet, has ended early, or its output has no state = true",
                remedy=f"state = true in [output] of {self.deck}, then umform run {folder / self.deck} --out "
                f"{path.parent}",
            )
        tree = read_tree(path, STATE_KIND)
        bodies = {body.key: {name: values.shape for name, values in body.state().items()} for body in model.bodies}
        there = {key: {name: values.shape for name, values in one.items()} for key, one in tree["bodies"].items()}
        other = [key for key in TAKEN if tree.get("tables", {}).get(key) != _written(tables)[key]]
        if (
            other
            or tree["u"].shape != model.u.shape
            or not np.array_equal(tree["points"], model.mesh.points)
            or there != bodies
        ):
            raise FileProblem(
                "the state belongs to another model",
                where=str(path),
                value=f"{len(tree['points'])} nodes in the file, {len(model.mesh.points)} of the deck"
                + (f"; {' and '.join(other)} of the run: other than in the deck" if other else ""),
                cause="the deck before has been changed since its run, or the file is that of another one",
                remedy=f"run {self.deck} again",
            )
        if self.control is None:  # a run of its own
            model.system.restore(Snapshot(tree["u"], terms=tree["bodies"]))
        else:
            model.system.restore(Snapshot(tree["u"], tree["time"], terms=tree["bodies"], began=tree["began"]))

    def kept(self, folder: File) -> dict[str, KeptContact]:
        """The history of the contacts that keep it.

        Raises
        ------
        FileProblem
            If the state does not have them.
        """
        found = read_tree(folder / self.state, STATE_KIND).get("contacts", {}) if self.keep else {}
        if missing := [name for name in self.keep if name not in found]:
            raise FileProblem(
                "the state has no contact of this name",
                where=str(folder / self.state),
                value=", ".join(missing),
                cause="another name, or the state of an older program, which has contacts with friction only",
                remedy="one of " + ", ".join(found) if found else f"run {self.deck} again",
            )
        return {
            name: KeptContact(
                np.asarray(one["faces"]),
                one["history"],
                json.loads(one["names"]),
                float(one.get("penalty", 0.0)),
                one.get("feet"),
                one.get("over_cells"),
                one.get("gaps"),
            )
            for name, one in ((name, found[name]) for name in self.keep)
        }

    def keep_friction(
        self, model: Model, kept: Mapping[str, KeptContact], contacts: Mapping[str, Contact | SheetContact]
    ) -> None:
        """Give contacts of the present deck the history that they keep.

        Raises
        ------
        InvalidValue
            If one is missing, or has other points.
        """
        for name, friction in kept.items():
            if name not in contacts:
                raise InvalidValue(
                    "the deck has no contact of this name",
                    where="keep",
                    value=name,
                    cause="" if contacts else "it has no contacts",
                    remedy=f"one of {', '.join(contacts)}" if contacts else "the contact, or no keep",
                )
            model.system.evaluate(model.system.x)
            contacts[name].begin()
            friction.put(contacts[name])


class Placement(Part):
    """Rigid motion of the part, with its state, before the first step: x becomes Q x + c. eq. (5.91)"""

    rotation: Annotated[list[Vector], Field(min_length=3, max_length=3)]
    """Rows of Q."""
    shift: Vector = (0.0, 0.0, 0.0)
    """c."""

    @classmethod
    def table(cls, motion: RigidMotion) -> dict[str, Any]:
        """The table of a motion."""
        return {"rotation": motion.rotation.tolist(), "shift": motion.shift.tolist()}

    def __post_init__(self) -> None:
        """Refuse a matrix that is no rotation."""
        Q = np.array(self.rotation)
        if not np.allclose(Q @ Q.T, np.eye(3), atol=1e-9) or np.linalg.det(Q) < 0.0:
            raise InvalidValue(
                "the rows of a rotation are orthogonal unit vectors, right-handed",
                where="rotation",
                value=self.rotation,
                cause="rounded digits, an angle, or a mirror image",
                remedy="the cosines with all digits: [[0, -1, 0], [1, 0, 0], [0, 0, 1]] turns by 90 degrees about z",
            )

    @property
    def motion(self) -> RigidMotion:
        """The motion."""
        return RigidMotion(np.array(self.rotation), np.array(self.shift))

    def apply(self, model: Model) -> None:
        """Move a model that has no tools and supports yet."""
        state = model.system.snapshot()
        model.system.restore(replace(state, u=self.motion.displacement(model.mesh.points, state.u)))


class Cut(Part):
    """A cut along a line."""

    line: ProfilePart
    """Lines and arcs in the view; the part is on the left of the direction of travel. The first and the last line of an
    open one extend to infinity."""
    view: Literal["x", "y", "z"] = "z"
    """Direction of the view: the coordinates of the line are y, z; x, z; or x, y."""
    formed: bool = True
    """Whether the line lies on the formed part, where the deck before has left it, or on the flat blank."""
    edge: Literal["line", "elements"] = "line"
    """Whether the new edge lies on the line, by new elements that take their state from the sheet, or follows edges of
    elements."""

    def build(self, folder: File) -> Trim:
        """The cut."""
        from umform.model.transfer.trim import Trim  # most decks have no cut

        return Trim(profile_of(self.line, folder), self.view, self.formed, self.edge)


def write_state(model: Model, path: File, tables: Mapping[str, Any], note: Mapping[str, Any] | None = None) -> None:
    """Write displacements, the history of all bodies, the data of this deck, and a note to build the model again."""
    state = model.system.snapshot()
    bodies = {body.key: state.terms[body.key] for body in model.bodies}
    contacts = {
        name: {
            "faces": kept.faces,
            "history": kept.history,
            "names": json.dumps(kept.history_variables),
            "penalty": kept.penalty,
            "over_cells": kept.over_cells,
            **{key: part for key, part in (("feet", kept.feet), ("gaps", kept.gaps)) if part is not None},
        }
        for name, kept in ((pair.name, KeptContact.of(pair)) for pair in model.system.touching)
    }
    tree = {"points": model.mesh.points, "u": state.u, "time": state.time, "began": state.began, "bodies": bodies}
    tree |= {"contacts": contacts} if contacts else {}
    write_tree(path, {**tree, "tables": _written(tables), "note": dict(note or {})}, STATE_KIND)


def _written(tables: Mapping[str, Any]) -> dict[str, str]:
    """The tables that the next operation takes, each as one text."""
    return {key: json.dumps(tables.get(key, {}), sort_keys=True, default=str) for key in TAKEN}


def merged(source: Source, before: Source) -> Source:
    """A deck with the tables of the previous deck.

    Raises
    ------
    DeckError
        If it also has one of them.
    """
    own = [key for key in TAKEN if key in source.data]
    if own:
        raise DeckError(
            DeckKey(
                f"{key} is that of the deck before",
                where=source.place((key,)),
                cause="a part keeps its mesh, its material and its element from one operation to the next",
                remedy=f"take the table {key} out",
            )
            for key in own
        )
    return replace(source, data={**source.data, **{key: before.data[key] for key in TAKEN if key in before.data}})
