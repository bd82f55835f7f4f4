"""The form of the page as data, and the parameters of the bend that follow from it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Gt, Le
from pydantic import Field, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from umform.bench.shelf import Shelf
from umform.bench.wanted_strips import WantedStrip
from umform.materials import J2, Metal
from umform.processes.air_bending.bottoming import with_travel
from umform.processes.air_bending.drawn_tools import drawn_sizes
from umform.processes.air_bending.goal import check_angle
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence import BendSequence
from umform.processes.hemming import Hemming
from umform.spec import About
from umform.spec.types import Degrees, Length, Positive, Rolling, Stress

#: Meshes by name: a quick look, the default of `umform bend`, and what docs/air-bending.md says is better.
MESHES: dict[str, dict[str, Any]] = {
    "quick": {"layers": 1, "elements_per_thickness": 1.0, "increment": 0.02},
    "usual": {},
    "fine": {"layers": 4, "thickness_points": 5},
}

#: Kinds of work.
WORKS = ("bend", "bottom", "sequence", "hem")

#: A longer sheet is no part of a press brake, and would take the memory of the server, in mm.
_LONGEST = 20000.0
#: Parameters of `AirBending` that the form asks for by their own names.
SIZES = ("thickness", "opening", "die_angle", "die_radius", "punch_angle", "punch_radius", "rolling")


class Wanted(WantedStrip):
    """A bend, or several, in mm, degrees and MPa.

    Attributes
    ----------
    work : str
        "bend": one bend in the air; "bottom": pressed onto the flanks of the die; "sequence": several bends in one
        part; "hem": an acute bend, flattened.
    material : str
        Metal of the library.
    yield_stress, tensile_strength, uniform_elongation : float or None
        Re, Rm, and Ag in percent, of a coil; None: those of the library.
    rolling : float or None
        Degrees from the bend line to the rolling direction.
    thickness, opening, die_angle, die_radius, punch_angle, punch_radius : float
        See `AirBending`.
    punch, die : str or None
        Drawn tools by their names; the numbers of the tool are then those of its drawing.
    angle, stroke : float or None
        What is wanted of a bend in the air: one of them.
    press_force, travel : float or None
        What is wanted of bottoming, one of them: force in kN/m, or way in mm beyond where flanks and tip are one
        thickness from the die.
    length : float
        Length of the bend, for the force in kN.
    whole : bool
        Whether the whole length is computed with its free ends, in place of plane strain.
    mesh : str
        A name of `MESHES`.
    budget : bool
        Whether the error budget is wanted.
    """

    work: Literal["bend", "bottom", "sequence", "hem"] = "bend"
    material: Annotated[str, Field(min_length=1, max_length=60)] = "DC04"
    yield_stress: Stress | None = None
    tensile_strength: Stress | None = None
    uniform_elongation: Annotated[float, Gt(0.0), Le(80.0), About("%")] | None = None
    rolling: Rolling | None = AirBending.rolling
    thickness: Length = AirBending.thickness
    opening: Annotated[Length, Le(_LONGEST)] = AirBending.opening
    die_angle: Degrees = AirBending.die_angle
    die_radius: Length = AirBending.die_radius
    punch_angle: Degrees = AirBending.punch_angle
    punch_radius: Length = AirBending.punch_radius
    punch: Annotated[str, Field(min_length=1, max_length=40)] | None = None
    die: Annotated[str, Field(min_length=1, max_length=40)] | None = None
    angle: Degrees | None = 90.0
    stroke: Length | None = None
    press_force: Annotated[Positive, About("kN/m")] | None = None
    travel: Annotated[float, About("mm")] | None = None
    length: Annotated[Length, Le(_LONGEST)] = 1000.0
    whole: bool = False
    mesh: Literal["quick", "usual", "fine"] = "usual"
    budget: bool = False

    @model_validator(mode="after")
    def _one_goal(self) -> Wanted:
        if self.work == "bottom":
            if (self.press_force is None) == (self.travel is None):
                raise PydanticCustomError("bottom_goal", "give the force or the way beyond the bottom, one of them")
        elif self.work == "bend" and (self.angle is None) == (self.stroke is None):
            raise PydanticCustomError("goal", "give the angle or the stroke, one of them")
        if (self.yield_stress is None) != (self.tensile_strength is None):
            raise PydanticCustomError("coil", "a coil has both, Re and Rm")
        if self.uniform_elongation is not None and self.yield_stress is None:
            raise PydanticCustomError("coil", "a coil has both, Re and Rm")
        return self

    def law(self) -> tuple[J2 | Metal, str]:
        """Law of the sheet, and a note on its source."""
        from umform.sheet_metals import get, of_certificate

        if self.yield_stress is None or self.tensile_strength is None:
            metal = get(self.material, self.thickness)
        else:
            elongation = None if self.uniform_elongation is None else 0.01 * self.uniform_elongation
            metal = of_certificate(self.material, self.yield_stress, self.tensile_strength, elongation)
        return metal.law, metal.note

    def case(self, shelf: Shelf | None = None) -> AirBending:
        """Parameters of the bend; an angle that the tools cannot reach is refused.

        Parameters
        ----------
        shelf : Shelf, optional
            Where drawn tools are.

        Raises
        ------
        InvalidValue
            ``where`` is the name of the parameter.
        """
        case = self.at_tools(shelf)
        if self.of_strip:
            self.strip(case)
        elif self.work == "bend" and self.angle is not None:
            check_angle(case, self.angle)
        return case

    def at_tools(self, shelf: Shelf | None = None) -> AirBending:
        """Parameters of the bend, whatever angle is wanted."""
        drawn: dict[str, Any] = {}
        for kind, name in self.drawn.items():
            if name is not None:
                drawn[f"{kind}_section"] = (shelf or Shelf(Path())).tool(kind, name)
        bottoms = self.work == "bottom"
        case = AirBending(
            **{name: getattr(self, name) for name in SIZES},
            **drawn,
            width=self.length if self.whole and not self.of_strip else None,
            stroke=self.stroke if self.work == "bend" else None,
            bottoming=bottoms,
            material=self.law()[0],
            **MESHES[self.mesh],
        )
        return case if not bottoms or self.travel is None else with_travel(case, self.travel)

    @property
    def of_strip(self) -> bool:
        """Whether a whole strip is modelled, in place of half of a bend."""
        return self.work in ("sequence", "hem")

    def strip(self, sheet: AirBending) -> BendSequence | Hemming:
        """The bends of a part, or the hem."""
        return self.hem(sheet) if self.work == "hem" else self.sequence(sheet)

    @property
    def drawn(self) -> dict[str, str | None]:
        """Names of the drawn tools."""
        return {"punch": self.punch, "die": self.die}

    def as_ordered(self, case: AirBending) -> Wanted:
        """The same with the sizes of its drawn tools, without goals of other kinds of work."""
        others = {} if self.work == "bend" else {"angle": None, "stroke": None}
        return self.model_copy(update={**others, **drawn_sizes(case.punch_section, case.die_section)})

    @property
    def title(self) -> str:
        """A few words for lists."""
        if self.work == "sequence":
            return f"{self.material} {self.thickness:g} mm, {' '.join(f'{one.angle:g}°' for one in self.bends)}"
        if self.work == "hem":
            return f"{self.material} {self.thickness:g} mm, hem {self.gap:g} mm"
        if self.work == "bottom":
            goal = f"{self.press_force:g} kN/m" if self.press_force is not None else f"{self.travel:+g} mm"
        else:
            goal = f"{self.angle:g}°" if self.angle is not None else f"{self.stroke:g} mm"
        return f"{self.material} {self.thickness:g} mm, V{self.opening:.4g}, {goal}"


def problems_of(error: ValidationError) -> list[dict[str, Any]]:
    """What is wrong with a form: field, kind of mistake, and its numbers, for the page to put into words."""
    found = []
    for row in error.errors(include_url=False, include_input=False):
        where = ".".join(str(part) for part in row["loc"][:1]) or "goal"
        row_number = next((part + 1 for part in row["loc"][1:2] if isinstance(part, int)), None)
        part = next((str(part) for part in row["loc"][2:3]), None)
        bounds = {key: value for key, value in row.get("ctx", {}).items() if isinstance(value, int | float | str)}
        given = {"where": where, "kind": row["type"], "bounds": bounds, "what": row["msg"]}
        found.append({**given, "row": row_number, "part": part})
    return found[:20]
