"""Large displacements and rotations, elastic: benchmarks of Sze, Liu & Lo (2004)."""

from umform_book.case import Chapter
from umform_book.nonlinear import (
    end_moment,
    end_shear,
    hemisphere,
    hinged_roofs,
    open_cylinder,
    pinched_cylinder,
    semi_cylinder,
    slit_annulus,
)

CHAPTER = Chapter(
    "Nonlinear obstacle course",
    "Large displacements and rotations, elastic: benchmarks of Sze, Liu & Lo (2004).",
    (
        end_shear.CASE,
        end_moment.CASE,
        slit_annulus.CASE,
        hemisphere.CASE,
        open_cylinder.CASE,
        pinched_cylinder.CASE,
        semi_cylinder.CASE,
        hinged_roofs.THICK,
        hinged_roofs.THIN,
    ),
)
