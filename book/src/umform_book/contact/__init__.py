"""Rigid tools: pressure, penetration, Hertz, wrapping, rolling."""

from umform_book.case import Chapter
from umform_book.contact import (
    beam_on_cylinder,
    cells,
    hertz_line,
    hertz_point,
    penalty,
    pressure_patch,
    rolling_edge,
    wrapping,
)

CHAPTER = Chapter(
    "Contact",
    "Rigid tools: pressure, penetration, Hertz, wrapping, rolling.",
    (
        pressure_patch.CASE,
        hertz_line.CASE,
        hertz_point.CASE,
        beam_on_cylinder.CASE,
        wrapping.CASE,
        rolling_edge.CASE,
        penalty.CASE,
        cells.CASE,
    ),
)
