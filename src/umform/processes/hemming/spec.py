"""Hemming: its parameters, and the first bend."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Le

from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import refuse_stack
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.spec import About, check_fields, names_its_words, parameters
from umform.spec.types import FOLLOWS, Size

#: Sizes of the tools of the first bend for a sheet of 1 mm: a V of 30 degrees.
ACUTE: dict[str, float] = {
    "opening": 8.0,
    "die_angle": 30.0,
    "die_radius": 1.0,
    "punch_angle": 30.0,
    "punch_radius": 0.5,
}
#: Mesh and element of a hem: small 8-node elements stay valid in a closed fold, where those with 18 nodes invert.
FOLDED: dict[str, Any] = {"element": "ANS3DEAS", "elements_per_thickness": 4.0}
#: Largest angle of the first bend in degrees that plates can flatten.
LARGEST_ANGLE = 70.0
#: Forms of a hem, and the gap that each has over the thickness where none is given.
GAPS: dict[str, float] = {"flat": 0.0, "inner": 1.0, "insert": 1.0, "open": 1.0, "rope": 0.0}
#: Forms whose results follow changes of sizes of some per cent smoothly (docs/bending-operations.md).
_SMOOTH = ("insert", "open")
#: Forms whose flange is closed on what it lies on.
CLOSED = ("flat", "inner", "rope")


def scaled(sizes: Mapping[str, float], factor: float) -> dict[str, float]:
    """Sizes of tools with lengths times a factor; angles stay."""
    known = parameters(AirBending)
    return {name: size * factor if known[name].about.unit == "mm" else size for name, size in sizes.items()}


def acute(thickness: float = 1.0, **given: Any) -> AirBending:
    """Sheet and tools of the first bend; sizes that are not given follow from the thickness.

    Parameters
    ----------
    thickness : float
        Thickness of the sheet.
    **given : object
        Other parameters of `AirBending`.
    """
    return AirBending(thickness=thickness, **scaled(ACUTE, thickness) | FOLDED | given)


@names_its_words
@dataclass(frozen=True)
class Hemming:
    """Hemming in mm, N and MPa. ::

        ======================  plate, moved down
         .-------------------   flange
        (     [=============    inner sheet or insert; nothing in a flat, an open or a rope hem
         '------------------------------  base
        ======================  table

    The flange is bent to an acute angle in a V-die before.

    Examples
    --------
    >>> from umform.processes.hemming import Hemming
    >>> case = Hemming()
    >>> case.flange / case.sheet.thickness, case.height
    (12.0, 2.0)
    """

    groups: ClassVar = {"form": "Hem", "increments": "Solution"}
    """Group of the parameters from each of these on."""
    proportions: ClassVar = {"flange": 12.0, "base": 30.0}
    """Lengths over the thickness where none is given."""

    form: Literal["flat", "inner", "insert", "open", "rope"] = "flat"
    """Form of the hem: flat closes the flange on the base (2t); inner has an inner sheet of the same metal (3t),
    insert a rigid plate; open has nothing, rope a flange that is closed at its tip only, with a loop at the fold."""
    gap: Annotated[
        float,
        Ge(0.0),
        Le(1e5),
        About("mm", cause="a sign", remedy="the thickness of the inner sheet or of the insert; 0 closes the hem"),
    ] = FOLLOWS
    """Distance of flange and base, and thickness of inner sheet or insert; the plate stops at two thicknesses and the
    gap above the table. Without it, 0 in a flat and a rope hem, else one thickness."""
    force: Annotated[
        float | None,
        Gt(0.0),
        Le(1e6),
        About("kN/m", cause="a sign", remedy="a force per length of hem; the table of the documentation has some"),
    ] = None
    """Force of the plate per length of hem, at which it stops; without it, the plate moves to its height."""
    flange: Size = FOLLOWS
    """Length of the flange, flat, from the bend line to its end."""
    base: Size = FOLLOWS
    """Length of the base, flat, from the bend line to its end."""
    insert_from: Size | None = None
    """Distance of inner sheet or insert from the inner face at the bend line; without it, three thicknesses."""
    loop: Size | None = None
    """Distance of the plate of a rope hem from the bend line; without it, half of the flange."""
    angle: Annotated[
        float,
        Ge(20.0),
        Le(LARGEST_ANGLE),
        About(
            "degrees",
            cause="the angle of bending in place of that between the legs",
            remedy="40, with a die and a punch of 30 degrees",
        ),
    ] = 40.0
    """Angle between the legs after the first bend and its springback, unless the sheet has a stroke; a larger one
    cannot be flattened between plates."""
    sheet: AirBending = field(default_factory=acute)
    """Thickness, material, mesh, and tools of the first bend; in plane strain."""
    increments: Annotated[int, Ge(6), Le(10000), About(cause="a length")] = 120
    """Increments of the travel of the plate."""

    def __post_init__(self) -> None:
        check_fields(self)
        refuse_stack(self.sheet, "sheet")
        for name, thicknesses in (self.proportions | {"gap": GAPS[self.form]}).items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, thicknesses * self.sheet.thickness)
        self._check_gap()
        if self.base < self.flange:
            raise InvalidValue(
                "the base of a hem is longer than its flange",
                where="base",
                value=self.base,
                cause="the two exchanged",
                remedy=f"more than {self.flange:g}",
            )
        try:
            _ = self.first  # refuses a flange that is too short for the die
        except InvalidValue as error:
            error.where = error.where.removeprefix("bend 1, ")
            raise

    def _check_gap(self) -> None:
        """Refuse a gap, a loop and an edge of a sheet that the form does not have."""
        found = f"the form of the hem is {self.form}"
        if self.form == "flat" and self.gap > 0.0:
            raise InvalidValue(
                "a flat hem has no gap",
                where="gap",
                value=self.gap,
                cause=found,
                remedy="the form open, inner or insert",
            )
        if self.gap == 0.0 and GAPS[self.form] > 0.0:
            raise InvalidValue(
                "an open hem has a gap, an inner sheet or an insert a thickness",
                where="gap",
                value=self.gap,
                cause=found,
                remedy="more than 0, or the form flat",
            )
        if self.loop is not None and (self.form != "rope" or self.loop >= self.flange):
            raise InvalidValue(
                "only a rope hem has a loop, which ends before its flange does",
                where="loop",
                value=self.loop,
                cause=found if self.form != "rope" else f"the flange is {self.flange:g} long",
                remedy="a rope hem, and less than its flange",
            )
        wrong = self.insert_edge >= self.flange if self.is_filled else self.insert_from is not None
        if wrong:
            raise InvalidValue(
                "only a hem with an inner sheet or an insert has its edge, which lies below the flange",
                where="insert_from",
                value=self.insert_edge,
                cause=f"the flange is {self.flange:g} long" if self.is_filled else found,
                remedy="the form inner or insert, and less than its flange",
            )

    @property
    def is_closed(self) -> bool:
        """Whether the flange ends on the base or on the inner sheet."""
        return self.form in CLOSED

    @property
    def is_filled(self) -> bool:
        """Whether a sheet or a rigid insert lies in the fold."""
        return self.form in ("inner", "insert")

    @property
    def touches_itself(self) -> bool:
        """Whether sheets touch in the model: over a rigid insert, flange and base do not."""
        return self.form != "insert"

    @property
    def study(self) -> str:
        """Process of the studies of errors that has such hems: a sheet or plate in the fold makes it another one."""
        if self.force is not None:
            return "hem by force"
        return "hem, filled" if self.is_filled else f"hem, {self.form}"

    @property
    def loop_length(self) -> float:
        """Distance of the plate from the bend line; 0 for a plate over the whole hem."""
        return 0.0 if self.form != "rope" else 0.5 * self.flange if self.loop is None else self.loop

    @property
    def height(self) -> float:
        """Final distance of plate and table."""
        return 2.0 * self.sheet.thickness + self.gap

    @property
    def insert_edge(self) -> float:
        """Distance of inner sheet or insert from the inner face at the bend line."""
        return 3.0 * self.sheet.thickness if self.insert_from is None else self.insert_from

    @property
    def strokes(self) -> dict[str, str]:
        """Path of the stroke that is looked for, by the name of the angle of the first bend."""
        return {} if self.sheet.stroke is not None else {"first_angle": "sheet.stroke"}

    @property
    def first(self) -> BendSequence:
        """The first bend."""
        stroke = self.sheet.stroke
        bend = Bend(self.flange, self.angle) if stroke is None else Bend(self.flange, stroke=stroke)
        return BendSequence(self.flange + self.base, (bend,), replace(self.sheet, stroke=None))


def jumps(case: Hemming) -> bool:
    """Whether results of hems of this form jump beside their derivatives (docs/bending-operations.md)."""
    return case.form not in _SMOOTH
