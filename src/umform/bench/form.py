"""The form of the page: the parameters of the processes and the choices of the bench, read off their Specs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field
from functools import cache
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Le

from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.spec import AirBending, SizeOf
from umform.processes.bend_sequence import BendSequence
from umform.processes.hemming import Hemming
from umform.spec import About, Parameter, note_of, parameters
from umform.spec.types import Degrees, Length, Positive, Stress

#: Kinds of work: those in the tools, and those with a view of their own.
WORKS = ("bend", "bottom", "sequence", "hem", "correct", "flat", "table")
_IN_TOOLS = WORKS[:5]
#: Meshes by name: a quick look, the default of `umform bend`, and what docs/air-bending.md says is better.
MESHES: dict[str, dict[str, Any]] = {
    "quick": {"layers": 1, "elements_per_thickness": 1.0, "increment": 0.02},
    "usual": {},
    "fine": {"layers": 4, "thickness_points": 5},
}
#: Longest bend, and longest strip of several bends or a hem, in mm: a longer one would take the memory of the server.
LONGEST, LONGEST_STRIP = 20000.0, 4000.0
#: Fields that stand first; those of these groups follow, the other groups are folded away.
_FIRST = ("work", "part", "material", "metals", "thickness", "thicknesses", "opening", "openings", "angles", "length")
_SHOWN = ("What to do", "Measured bend", "Part", "Hem", "Flat pattern", "Bend table")
#: What the form contains at first, where the Spec has no default.
_AT_FIRST = {"angle": 90.0, "strip_length": 80.0, "angles": [90.0, 105.0, 120.0, 135.0, 150.0]}
_BENDS = ({"position": 20.0, "angle": 90.0}, {"position": 60.0, "angle": 90.0})
#: Parameters that the chosen mesh determines where they are empty.
BY_MESH = frozenset(name for mesh in MESHES.values() for name in mesh)


@dataclass(frozen=True)
class Choices:
    """What the form asks besides the parameters of the processes."""

    groups: ClassVar = {"work": "What to do", "die": "Tools", "yield_stress": "Sheet", "mesh": "Solution"}
    """Group of the parameters from each of these on."""

    work: Literal["bend", "bottom", "sequence", "hem", "correct", "flat", "table"] = "bend"
    """Kind of work."""
    material: str = "DC04"
    """Material; a sheet metal of the library."""
    length: Length = 1000.0
    """Length of the bend, for the force in kN."""
    die: str | None = None
    """Die; by numbers, or from a drawing."""
    punch: str | None = None
    """Punch; by numbers, or from a drawing."""
    yield_stress: Stress | None = None
    """Yield stress Re or Rp0.2 of the coil; without it, that of the library."""
    tensile_strength: Stress | None = None
    """Tensile strength Rm of the coil; without it, that of the library."""
    uniform_elongation: Annotated[float, Gt(0.0), Le(80.0), About("%", cause="another unit")] | None = None
    """Uniform elongation Ag of the coil; without it, that of the library."""
    mesh: Literal["quick", "usual", "fine"] = "usual"
    """Mesh; it determines the parameters below that are empty."""
    budget: bool = False
    """Error budget; the bend is repeated with refinements."""
    whole: bool = False
    """Free ends; the whole length is modelled, in place of plane strain."""


@dataclass(frozen=True)
class Measured:
    """What was measured of a bend, to correct its metal."""

    groups: ClassVar = {"measured_angle": "Measured bend"}
    """Group of the parameters from each of these on."""

    measured_angle: Degrees | None = None
    """Measured angle between the legs after springback."""
    measured_force: Annotated[Positive, About("kN/m")] | None = None
    """Measured force at the stroke; without it, only the flow stress is corrected."""
    measured_radius: Length | None = None
    """Measured inside radius."""
    issue_again: str | None = None
    """Bend table to issue again; a finished table of this metal."""


@dataclass(frozen=True)
class FlatChoices:
    """What the form asks of a part that is unfolded."""

    groups: ClassVar = {"part": "Flat pattern"}
    """Group of the parameters from each of these on."""

    part: str | None = None
    """Part; a STEP file of one bent part."""
    die_opening: Length | None = None
    """Opening of the dies; without it, 8 to 12 thicknesses, by the radius of the drawing."""
    k_factor: Annotated[float, Ge(0.0), Le(1.0), About(cause="the factor of DIN 6935, or percent")] | None = None
    """K-factor of ANSI in place of computed bends; without it, bends are computed."""
    simulated: bool = False
    """Whether the whole part is bent by simulation."""


@dataclass(frozen=True)
class TableChoices:
    """What the form asks of a bend table."""

    groups: ClassVar = {"check": "Bend table"}
    """Group of the parameters from each of these on."""

    check: bool = False
    """Whether the errors between the angles are measured by more runs."""


@dataclass(frozen=True)
class FormField:
    """A field of the form.

    Attributes
    ----------
    name : str
        Its name in the form.
    parameter : Parameter
        The parameter of a Spec.
    group : str
        Its group; empty for those that are not folded away.
    works : tuple of str
        Kinds of work that have it.
    many : bool
        Whether its value is a list of values of the parameter.
    """

    name: str
    parameter: Parameter
    group: str
    works: tuple[str, ...]
    many: bool = False

    @property
    def kind(self) -> str:
        """How the page asks for it: "bends", "select", "check" or "number"; of lists "words" or "numbers"."""
        types = {kind.type for kind in self.parameter.kinds}
        if self.name == "bends":
            return self.name
        if self.many:
            return "words" if types == {str} else "numbers"
        return "select" if types == {str} else "check" if types == {bool} else "number"

    @property
    def times(self) -> float | None:
        """Its value over the thickness where it is empty, if it follows from the thickness."""
        times: float | None = Hemming.proportions.get(self.name) if self.parameter.spec is Hemming else None
        return times

    @property
    def may_be_empty(self) -> bool:
        """Whether it may be left empty."""
        return self.parameter.absent or self.name in BY_MESH

    @property
    def default(self) -> Any:
        """What it contains at first, as JSON."""
        if self.kind == "bends":
            return [dict(bend) for bend in _BENDS]
        default = _AT_FIRST.get(self.name, self.parameter.default)
        if self.many and not isinstance(default, list):
            return [default]
        return None if default is MISSING or self.name in BY_MESH else default

    @property
    def most(self) -> float:
        """Largest length that the server takes."""
        return LONGEST_STRIP if self.parameter.spec in (BendSequence, Hemming) else LONGEST

    def record(self) -> dict[str, Any]:
        """What the page needs of it."""
        one, size = self.parameter, None if self.many else note_of(self.parameter.hint, SizeOf)
        numbers = [kind for kind in one.kinds if kind.type in (int, float)]
        states, label = one.noun.startswith("whether "), one.noun.removeprefix("whether ")
        return {
            "name": self.name,
            "label": label if states else f"the {label}",
            "help": one.sentence if one.sentence.rstrip(".").lower() != one.noun.lower() else "",
            "valid": one.must_be if numbers else "",
            "unit": {"degrees": "°"}.get(one.about.unit, one.about.unit),
            "group": self.group,
            "works": list(self.works),
            "kind": self.kind,
            "integer": bool(numbers) and numbers[0].type is int,
            "bounds": {name: limit for kind in numbers for name, limit, _, _ in kind.limits()},
            "choices": [choice for kind in one.kinds for choice in kind.choices],
            "default": self.default,
            "times": self.times,
            "tool": size.tool if size else "",
            "size": size.size if size else "",
        }


@dataclass(frozen=True)
class _Source:
    """A Spec whose parameters the form has.

    ``works``: the kinds of work that have them; ``only``: those of single parameters; ``called``: other names in the
    form; ``omit``: parameters that follow from the choices; ``many``: lists of the parameters of ``called``.
    """

    spec: type
    works: tuple[str, ...] = WORKS
    only: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    called: Mapping[str, str] = field(default_factory=dict)
    omit: tuple[str, ...] = ()
    many: bool = False


#: Parameters of which a bend table has lists.
MANY = {
    "thickness": "thicknesses",
    "opening": "openings",
    "punch_radius": "punch_radii",
    "die_radius": "die_radii",
}
_ALONE, _NO_TABLE = ("bend", "bottom", "correct"), WORKS[:6]
_SOURCES = (
    _Source(
        Choices,
        only={
            "budget": ("bend", "bottom"),
            "whole": _ALONE,
            **dict.fromkeys(("length", "die", "punch"), _IN_TOOLS),
            **dict.fromkeys(("material", "yield_stress", "tensile_strength", "uniform_elongation"), _NO_TABLE),
        },
    ),
    _Source(Choices, ("table",), called={"material": "metals"}, many=True),
    _Source(Goal, ("bend", "correct"), only={"force_per_metre": ("bottom",), "travel": ("bottom",)}),
    _Source(
        AirBending,
        only={
            "stroke": ("bend", "correct"),
            "width_elements": _ALONE,
            **dict.fromkeys(("thickness", "opening"), _IN_TOOLS),
            **dict.fromkeys(("punch_radius", "die_radius"), _NO_TABLE),
        },
        omit=("width", "bottoming"),
    ),
    _Source(AirBending, ("table",), called=MANY, many=True),
    _Source(Goal, ("table",), called={"angle": "angles"}, many=True),
    _Source(Measured, ("correct",)),
    _Source(FlatChoices, ("flat",)),
    _Source(TableChoices, ("table",)),
    _Source(BendSequence, ("sequence",), called={"length": "strip_length"}),
    _Source(Hemming, ("hem",), called={"angle": "first_angle"}),
)


@cache
def form_fields() -> Mapping[str, FormField]:
    """All fields of the form by name, in their order on the page."""
    found = [one for source in _SOURCES for one in _of(source)]
    groups = list(dict.fromkeys(["", *(one.group for one in found)]))
    place = {name: number for number, name in enumerate(_FIRST)}
    found.sort(key=lambda one: (groups.index(one.group), place.get(one.name, len(place))))
    return MappingProxyType({one.name: one for one in found})


def _of(source: _Source) -> list[FormField]:
    """Fields of a Spec: numbers, words and flags, and bends; no form can contain other objects."""
    groups: Mapping[str, str] = source.spec.groups  # type: ignore[attr-defined]
    found, group = [], ""
    for key, one in parameters(source.spec).items():
        group = groups.get(key, group)
        plain = all(kind.choices or kind.type in (int, float, bool, str) for kind in one.kinds)
        if key in source.omit or not (plain or key == "bends") or (source.many and key not in source.called):
            continue
        name = source.called.get(key, key)
        shown = group in _SHOWN or name in _FIRST
        works = source.only.get(key, source.works)
        found.append(FormField(name, one, "" if shown else group, works, source.many))
    return found
