"""Finite strains and plastic flow, against closed forms and converged solutions."""

from umform_book.case import Chapter
from umform_book.plastic import (
    cook,
    hourglass_stability,
    necking,
    pinched_cylinder,
    plate_bending,
    pulled_bend,
    tension,
    thick_walled_tube,
    thickness_points,
)

CHAPTER = Chapter(
    "Elasto-plastic",
    "Finite strains and plastic flow, against closed forms and converged solutions.",
    (
        plate_bending.CASE,
        thickness_points.CASE,
        pulled_bend.CASE,
        thick_walled_tube.CASE,
        tension.CASE,
        hourglass_stability.CASE,
        necking.CASE,
        cook.CASE,
        pinched_cylinder.CASE,
    ),
)
