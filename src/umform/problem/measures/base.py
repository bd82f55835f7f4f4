"""What a measure of a deck is taken of, and what comes out of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.model import Model, Tool
from umform.model.transfer.beside import PART
from umform.model.transfer.rigid_motion import RigidMotion
from umform.problem.parts import Part
from umform.report.symmetry import Mirror, mirrors, mirrors_of_blank, whole
from umform.results.forming import Laid
from umform.results.quantity import Quantity
from umform.results.shape import Shape, outer_quads

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from umform.problem.prepared import Prepared
    from umform.problem.settings import Units

Floats = NDArray[np.float64]
_P = TypeVar("_P", Shape, Laid)

#: The states of a part: at the end of the last step before all those that release it, and at the end of the run.
FORMED, RELEASED = "formed", "released"
#: Width of a strip in plane strain in pictures, as a part of its length.
_WIDE = 0.3


#: One number of a measure in the states where it exists.
Row = Mapping[str, Quantity]


def in_states(label: str, unit: str, **states: float | None) -> Row:
    """A number by the names of the states."""
    return {state: Quantity(label, unit, value=value, digits=5) for state, value in states.items()}


@dataclass(frozen=True)
class Measured:
    """Outcome of a measure.

    Attributes
    ----------
    rows : list of mapping of str to Quantity
        Numbers in the states of the part.
    columns : dict of str to ndarray
        Table of its curve or its map.
    picture : callable
        Draws it.
    caption : str
        Of the picture.
    """

    rows: list[Row]
    columns: Mapping[str, Floats]
    picture: Callable[[], Figure]
    caption: str


@dataclass(frozen=True)
class Formed:
    """A part in its states.

    Attributes
    ----------
    result : Result
        The run.
    problem : Prepared
        Its problem.
    states : dict of str to ndarray, shape (n, 3)
        Displacements by the names of the states.
    row : int
        Row of the history of the formed state.
    units : Units
        Names of the units.
    tools : dict of str to str
        The first contact of each tool that has one.
    placed : RigidMotion, optional
        Motion of the part into other tools, from the place of its blank.
    """

    result: Result
    problem: Prepared
    states: dict[str, Floats]
    row: int
    units: Units
    tools: dict[str, str] = field(default_factory=dict)
    placed: RigidMotion | None = None

    @classmethod
    def of(cls, result: Result, problem: Prepared, loading: int, complete: bool, **names: Any) -> Formed:
        """The states of a run.

        Parameters
        ----------
        result : Result
            The run, with a frame at the end of each step.
        problem : Prepared
            Its problem.
        loading : int
            Number of its steps before those that release the part.
        complete : bool
            Whether the run has reached its end; a part that is released half is not measured.
        names
            The other attributes.
        """
        last = len(result.rows) - 1
        end = result.model.u.reshape(-1, 3).copy()
        loaded = [frame for frame in result.frames if result.rows[frame.number]["step"] <= loading]
        if not loaded or result.rows[last]["step"] <= loading:
            return cls(result, problem, {FORMED: end}, last, **names)
        states = {FORMED: loaded[-1].points["displacement"]}
        return cls(result, problem, states | ({RELEASED: end} if complete else {}), loaded[-1].number, **names)

    @property
    def model(self) -> Model:
        """The model."""
        return self.result.model

    @property
    def planes(self) -> list[Mirror]:
        """Planes of symmetry, where they are in its states."""
        return mirrors(self.model)

    @property
    def planes_of_blank(self) -> list[Mirror]:
        """The same planes in the blank."""
        return mirrors_of_blank(self.model)

    @property
    def last(self) -> str:
        """Name of the last state."""
        return RELEASED if RELEASED in self.states else FORMED

    def places(self, state: str) -> Floats:
        """Positions of the nodes in a state, shape (n, 3)."""
        places: Floats = self.model.mesh.points + self.states[state]
        return places

    def from_blank(self, state: str) -> Floats:
        """Displacements (n, 3) of the part in a state from its blank, without its motion into other tools."""
        if self.placed is None:
            return self.states[state]
        u, mesh = self.states[state].copy(), self.model.mesh
        own = mesh.nodes(PART) if PART in mesh.sets else np.arange(len(u))  # not sheets that were laid beside it
        u[own] = self.placed.back.displacement(mesh.points[own], u[own]).reshape(-1, 3)
        return u

    def tool(self, name: str) -> Tool | None:
        """The tool of a model, by its name in the deck; None if nothing touches it."""
        return self.problem.contacts[self.tools[name]].tool if name in self.tools else None

    def shape(self, state: str, **values: Floats) -> Shape:
        """The whole part in a state with fields of its nodes or cells, for pictures."""
        mesh = self.model.mesh
        quads, owners = outer_quads(mesh.connectivity.astype(np.int64))
        on_faces = {k: v[quads].mean(axis=1) if len(v) == len(mesh.points) else v[owners] for k, v in values.items()}
        return self.shown(whole(Shape(self.places(state), quads, on_faces), self.planes))

    def shown(self, whole_part: _P) -> _P:
        """A part, as shape or laid in its gauge, for pictures: a narrow strip in plane strain is wider."""
        held = self.model.supports.constrained().reshape(-1, 3)
        length, width = np.ptp(self.model.mesh.points[:, :2], axis=0)
        if not held[:, 1].all() or width > _WIDE * length:
            return whole_part
        return replace(whole_part, points=whole_part.points * np.array([1.0, _WIDE * length / width, 1.0]))


class MeasurePart(Part):
    """Common base of the measures of a deck."""

    #: What the names of its numbers begin with.
    numbers: ClassVar[tuple[str, ...]] = ("",)

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse before the run what cannot be measured.

        Parameters
        ----------
        model : Model
            The model before the run.
        released : bool
            Whether the last steps release the part.
        """

    def take(self, name: str, part: Formed) -> Measured:
        """Measure a part."""
        raise NotImplementedError
