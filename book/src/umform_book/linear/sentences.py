"""A sentence with the numbers of a study."""

from __future__ import annotations

from collections.abc import Sequence

from umform_book.convergence import Study
from umform_book.variants import Variant, with_tying

#: An element that locks, and recommended ones.
COMPARED = (Variant("DISP3DEAS"), with_tying("ANS3DEAS"), with_tying("EAS3DEAS"), with_tying("MI9K3DEAS"))


def coarse_and_fine(found: Study, reference: float, variants: Sequence[Variant] = COMPARED) -> str:
    """Share of the reference that some elements reach on the coarsest and on the finest mesh."""
    parts = []
    for variant in variants:
        if variant in found:
            row = found[variant]
            coarse, fine = (100 * row[n] / reference for n in (min(row), max(row)))
            parts.append(f"{variant.label} {coarse:.1f} and {fine:.1f} %")
    meshes = next(iter(found.values()))
    return f"Part of the reference with {min(meshes)} and {max(meshes)} intervals: {'; '.join(parts)}."
