"""Bends with a radius near the thickness: the thickness strain they need."""

from umform_book.case import Chapter
from umform_book.sharp_bends import (
    elastic_accuracy,
    hinge,
    hinge_points,
    meshes,
    moment,
    over_cylinder,
    small_cylinders,
    springback,
    stability,
    thickness_strains,
    wide_strip,
)

CHAPTER = Chapter(
    "Sharp bends",
    "Bends with a radius near the thickness: the thickness strain they need.",
    (
        moment.CASE,
        thickness_strains.CASE,
        hinge_points.CASE,
        springback.CASE,
        hinge.CASE,
        over_cylinder.CASE,
        small_cylinders.CASE,
        wide_strip.CASE,
        meshes.CASE,
        elastic_accuracy.CASE,
        stability.CASE,
    ),
)
