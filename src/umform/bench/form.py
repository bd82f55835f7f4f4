"""The form of the page: the parameters of the processes and the choices of the bench, read off their Specs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field
from functools import cache
from types import MappingProxyType
from typing import Any

from umform.bench.choices import Choices, FlatChoices, Measured, TableChoices
from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.spec import AirBending, SizeOf
from umform.processes.air_bending.stack import StackedSheet
from umform.processes.bend_sequence import BendSequence
from umform.processes.bend_sequence.outside import OutsidePart
from umform.processes.draw.cup import ESAFORM, Cup
from umform.processes.draw.u_bend import NUMISHEET, UBend
from umform.processes.hemming import Hemming
from umform.processes.hemming.spec import FOLDED
from umform.spec import Parameter, note_of, parameters

#: Kinds of work: those in the tools of a press brake, drawn parts, and those with a view of their own.
_IN_TOOLS = ("bend", "bottom", "outside", "sequence", "hem", "correct")
DRAWS: dict[str, type[Cup] | type[UBend]] = {"cup": Cup, "u": UBend}
WORKS = (*_IN_TOOLS, *DRAWS, "flat", "table")
#: Meshes by name: a quick look, the default of `umform bend`, and what docs/air-bending.md says is better.
MESHES: dict[str, dict[str, Any]] = {
    "quick": {"layers": 1, "elements_per_thickness": 1.0},
    "usual": {},
    "fine": {"layers": 4, "thickness_points": 5},
}
#: Meshes of hems by the same names: with longer elements, or one layer, a closed fold inverts.
HEM_MESHES = {
    name: FOLDED | mesh | ({"layers": 2, "elements_per_thickness": 3.0} if name == "quick" else {})
    for name, mesh in MESHES.items()
}
#: Longest bend, and longest strip of several bends or a hem, in mm: a longer one would take the memory of the server.
LONGEST, LONGEST_STRIP = 20000.0, 4000.0
#: K of the lengths that are shown before the bends are computed.
ABOUT_K = 0.44
#: Fields that stand first; those of these groups follow, the other groups are folded away.
_FIRST = (
    *("work", "part", "material", "metals", "thickness", "thicknesses", "opening", "openings", "angles", "length"),
    *("cup_thickness", "cup_blank", "cup_punch", "cup_opening", "cup_punch_edge", "cup_die_edge", "cup_holder_force"),
    *("u_thickness", "u_length", "u_width", "u_punch_width", "u_opening", "u_punch_edge", "u_die_edge"),
    *("u_holder_force", "u_friction", "cup_friction"),
)
_SHOWN = ("What to do", "Measured bend", "Part", "Hem", "Flat pattern", "Bend table")
#: Before the names of the parameters of a second sheet.
SECOND = "second_"
#: What the form contains at first, where the Spec has no default.
_AT_FIRST: dict[str, Any] = {
    "angle": 90.0,
    f"{SECOND}thickness": 1.0,
    "strip_length": 80.0,
    "angles": [90.0, 105.0, 120.0, 135.0, 150.0],
    "bends": [{"position": 20.0, "angle": 90.0}, {"position": 60.0, "angle": 90.0}],
    "outside": {
        "flanges": [22.0, 44.0, 22.0],
        "bends": [{"line": line, "angle": 90.0, "direction": "up"} for line in (1, 2)],
    },
    **{f"u_{name}": value for name, value in NUMISHEET.items()},
    **{f"cup_{Cup.diameters.get(name, name)}": (1 + (name in Cup.diameters)) * one for name, one in ESAFORM.items()},
}
#: Meshes of drawn parts by the same names.
DRAW_MESHES: dict[str, dict[str, dict[str, Any]]] = {
    work: {"quick": spec.meshes["coarse"], "usual": {}, "fine": spec.meshes["fine"]} for work, spec in DRAWS.items()
}
#: Fields that the chosen mesh determines where they are empty.
BY_MESH = frozenset(name for mesh in MESHES.values() for name in mesh) | frozenset(
    f"{work}_{name}" for work, meshes in DRAW_MESHES.items() for mesh in meshes.values() for name in mesh
)


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
    double : bool
        Whether its value is twice the parameter: a diameter in place of a radius.
    """

    name: str
    parameter: Parameter
    group: str
    works: tuple[str, ...]
    many: bool = False
    double: bool = False

    @property
    def kind(self) -> str:
        """Kind of input on the page: "bends", "outside", "select", "check" or "number"; lists: "words" or "numbers"."""
        types = {kind.type for kind in self.parameter.kinds}
        if self.name in _COMPOSED:
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
        return (self.parameter.absent and not self.many) or self.name in BY_MESH

    @property
    def default(self) -> Any:
        """What it contains at first, as JSON."""
        default = _AT_FIRST.get(self.name, self.parameter.default)
        if self.many and not isinstance(default, list):
            return [default]
        return None if default is MISSING or self.name in BY_MESH else default

    @property
    def most(self) -> float:
        """Largest length that the server takes."""
        return LONGEST_STRIP if self.parameter.spec in (BendSequence, Hemming) else LONGEST

    def record(self) -> dict[str, Any]:
        """Its data for the page."""
        one, size = self.parameter, None if self.many else note_of(self.parameter.hint, SizeOf)
        numbers = [kind for kind in one.kinds if kind.type in (int, float)]
        states, label = one.noun.startswith("whether "), self.said(one.noun.removeprefix("whether "))
        sentence = self.said(one.sentence)
        return {
            "name": self.name,
            "label": label if states else f"the {label}",
            "help": sentence if one.sentence.rstrip(".").lower() != one.noun.lower() else "",
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

    def said(self, text: str) -> str:
        """A text of the parameter, of a diameter if the field has one."""
        return text.replace("radius", "diameter").replace("Radius", "Diameter") if self.double else text


@dataclass(frozen=True)
class _Source:
    """A Spec whose parameters the form has.

    ``works``: the kinds of work that have them; ``only``: those of single parameters; ``called``: other names in the
    form; ``omit``: parameters that follow from the choices; ``many``: lists of the parameters of ``called``;
    ``prefix``: before all names; ``double``: radii whose fields have diameters.
    """

    spec: type
    works: tuple[str, ...] = WORKS
    only: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    called: Mapping[str, str] = field(default_factory=dict)
    omit: tuple[str, ...] = ()
    many: bool = False
    prefix: str = ""
    double: tuple[str, ...] = ()


#: Parameters of several numbers, for which the page has rows.
_COMPOSED = ("bends", "outside")
#: Parameters of which a bend table has lists.
MANY = {
    "thickness": "thicknesses",
    "opening": "openings",
    "punch_radius": "punch_radii",
    "die_radius": "die_radii",
}
_ALONE, _BENT, _NO_TABLE = ("bend", "bottom", "correct"), (*_IN_TOOLS, "flat", "table"), (*_IN_TOOLS, "flat")
_METAL = (*_NO_TABLE, *DRAWS)
_SOURCES = (
    _Source(
        Choices,
        only={
            "budget": ("bend", "bottom"),
            "whole": _ALONE,
            "second_material": ("bend",),
            **dict.fromkeys(("length", "die", "punch"), _IN_TOOLS),
            **dict.fromkeys(("material", "yield_stress", "tensile_strength", "uniform_elongation"), _METAL),
        },
    ),
    _Source(Choices, ("table",), called={"material": "metals"}, many=True),
    _Source(Goal, ("bend", "correct"), only={"force_per_metre": ("bottom",), "travel": ("bottom",)}),
    _Source(
        AirBending,
        _BENT,
        only={
            "stroke": ("bend", "correct"),
            "width_elements": _ALONE,
            **dict.fromkeys(("thickness", "opening"), _IN_TOOLS),
            **dict.fromkeys(("punch_radius", "die_radius"), _NO_TABLE),
        },
        omit=("width", "bottoming"),
    ),
    _Source(StackedSheet, ("bend",), prefix=SECOND),
    _Source(AirBending, ("table",), called=MANY, many=True),
    _Source(Goal, ("table",), called={"angle": "angles"}, many=True),
    _Source(Measured, ("correct",)),
    _Source(FlatChoices, ("flat",)),
    _Source(TableChoices, ("table",)),
    _Source(BendSequence, ("sequence",), called={"length": "strip_length"}),
    _Source(OutsidePart, ("outside",), called={"bends": "outside"}, omit=("flanges",)),
    _Source(Hemming, ("hem",), called={"angle": "first_angle"}),
    _Source(
        Cup,
        ("cup",),
        called=Cup.diameters,
        omit=("element",),
        prefix="cup_",
        double=tuple(Cup.diameters),
    ),
    _Source(UBend, ("u",), omit=("element",), prefix="u_"),
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
        name = source.prefix + source.called.get(key, key)
        shown = group in _SHOWN or name in _FIRST
        works = source.only.get(key, source.works)
        found.append(FormField(name, one, "" if shown else group, works, source.many, key in source.double))
    return found
