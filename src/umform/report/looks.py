"""How formed parts look in all pictures in space: colours, lights, names of fields with their units.

PyVista (`rendering`), the pages of reports and the bench (``assets/space.js``) read them here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from umform.surfaces.triangulated import SHARP

#: Sheet without a field, tools, lines of elements, lines of rolling.
SHEET, TOOL, LINES, ROLLING = "#a9b8c6", "#b9c2cb", "#1c2733", "#b3261e"
#: Opacity of tools, of the lines of elements, and of the edges of tools.
TOOL_OPACITY, LINE_OPACITY, EDGE_OPACITY = 0.32, 0.45, 0.35
#: How far lines and tools are drawn before what they lie on, as a part of their size: chords of elements enter tools.
LINES_BEFORE, TOOLS_BEFORE = 5e-4, 2.5e-3
#: Light without a direction; how much sheet and tools shine, and the power of it.
AMBIENT, SHEET_SHINE, TOOL_SHINE = 0.42, (0.25, 30), (0.2, 1)
#: Direction to each light from the observer (right, up, towards), and its strength: from the left above, weaker from
#: the right, and from the observer.
LIGHTS = (((-0.6, 0.9, 0.8), 0.38), ((0.9, -0.3, 0.6), 0.26), ((0.0, 0.1, 1.0), 0.34))
#: Length of a line of rolling over the size of a face, how flat the direction must lie in it, and its height above it.
ROLLING_LENGTH, LYING, ROLLING_BEFORE = 0.3, 0.9, 0.02
#: Colours of the map in a page.
_STEPS = 64


@dataclass(frozen=True)
class Units:
    """Names of units; what is not known is left out.

    Attributes
    ----------
    length, force : str
        Of lengths and forces.
    """

    length: str = ""
    force: str = ""

    @property
    def stress(self) -> str:
        """Unit of stresses."""
        if (self.length, self.force) == ("mm", "N"):
            return "MPa"
        return f"{self.force}/{self.length}²" if self.length and self.force else ""

    @property
    def moment(self) -> str:
        """Unit of moments."""
        return f"{self.force} {self.length}" if self.length and self.force else ""


#: Units of a model that names none, and those of the processes.
UNKNOWN, MILLIMETRES = Units(), Units("mm", "N")


@dataclass(frozen=True)
class FieldLook:
    """How a field is shown.

    Attributes
    ----------
    words : str
        Its name for people.
    unit : str
        Kind of its unit, "length" or "stress", or the unit itself.
    factor : float
        Its values are multiplied by it.
    """

    words: str
    unit: str = ""
    factor: float = 1.0

    def unit_in(self, units: Units) -> str:
        """The unit."""
        return str(getattr(units, self.unit)) if self.unit in ("length", "stress") else self.unit

    def label(self, units: Units) -> str:
        """Name and unit."""
        unit = self.unit_in(units)
        return f"{self.words}, {unit}" if unit else self.words


_LOOKS = {
    "plastic_strain_max": FieldLook("largest plastic strain"),
    "plastic_strain_mean": FieldLook("mean plastic strain"),
    "thickness_change": FieldLook("thinning", "%", -100.0),
    "thickness": FieldLook("thickness", "length"),
    "thinning": FieldLook("thinning of the element", "%"),
    "stress_von_mises": FieldLook("von Mises stress", "stress"),
    "back_stress_von_mises": FieldLook("back stress, von Mises", "stress"),
    "modulus": FieldLook("Young's modulus", "stress"),
    "displacement": FieldLook("displacement", "length"),
    "contact_pressure": FieldLook("contact pressure", "stress"),
    "contact_gap": FieldLook("gap to tool or sheet", "length"),
    "friction_traction": FieldLook("friction", "stress"),
    "slip": FieldLook("distance slid", "length"),
    "limit_margin": FieldLook("margin to the forming limit"),
}
#: Fields that are shown first, in this order.
ORDER = tuple(_LOOKS)


def look_of(field: str) -> FieldLook:
    """How a field is shown, by its name in the frames."""
    return _LOOKS.get(field, FieldLook(field.replace("_", " ")))


def place(field: str) -> int:
    """Place of a field in a menu; others are the last."""
    return ORDER.index(field) if field in ORDER else len(ORDER)


def for_page() -> dict[str, Any]:
    """All of it as JSON data for the pages."""
    from umform.plotting import COLOUR_MAP  # the bench loads matplotlib after the first increments

    colours = COLOUR_MAP(np.linspace(0.0, 1.0, _STEPS), bytes=True)[:, :3]
    lights = [{"towards": list(towards), "strength": strength} for towards, strength in LIGHTS]
    return {
        "map": colours.tobytes().hex(),
        "colours": {"sheet": SHEET, "tool": TOOL, "lines": LINES, "rolling": ROLLING},
        "opacity": {"tool": TOOL_OPACITY, "lines": LINE_OPACITY, "edges": EDGE_OPACITY},
        "light": {"ambient": AMBIENT, "lamps": lights, "sheet": SHEET_SHINE, "tool": TOOL_SHINE},
        "edge": SHARP,
        "before": {"lines": LINES_BEFORE, "tools": TOOLS_BEFORE},
        "rolling": {"length": ROLLING_LENGTH, "lying": LYING, "before": ROLLING_BEFORE},
    }
