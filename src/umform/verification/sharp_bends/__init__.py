"""Bends whose radius is near the thickness: which thickness strain they need."""

from umform.verification.case import Chapter
from umform.verification.sharp_bends import hinge, moment, over_cylinder, stability, thickness_strains

CHAPTER = Chapter(
    "Sharp bends",
    "Bends whose radius is near the thickness: which thickness strain they need.",
    (moment.CASE, thickness_strains.CASE, hinge.CASE, over_cylinder.CASE, stability.CASE),
)
