"""Small displacements: beams, plates and shells with known answers, which reveal locking."""

from umform_book.case import Chapter
from umform_book.linear import (
    circular_plate,
    cook,
    curved_beam,
    hemisphere,
    pinched_cylinder,
    scordelis_lo,
    straight_beam,
    thick_cylinder,
    thin_shells,
    twisted_beam,
)

CHAPTER = Chapter(
    "Linear obstacle course",
    "Small displacements: beams, plates and shells with known answers, which reveal locking.",
    (
        straight_beam.CASE,
        curved_beam.CASE,
        twisted_beam.CASE,
        cook.CASE,
        thick_cylinder.CASE,
        circular_plate.CASE,
        scordelis_lo.CASE,
        pinched_cylinder.CASE,
        hemisphere.CASE,
        thin_shells.CASE,
    ),
)
