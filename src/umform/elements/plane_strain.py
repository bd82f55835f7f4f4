"""Elements for plane strain: nothing varies along s, so fewer Gauss points in s find the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from umform import _core
from umform.elements.technology import Element, Mode

#: Strains that are zero if nothing moves along s and nothing varies along it.
_ZERO = ("22", "12", "23")


def in_plane_strain(made: Element) -> Element:
    """The element for cells that do not move along s, and whose displacements do not vary along s.

    One Gauss point less in s is exact for the forces of a uniform stress, and the shear strains at these points still
    resist all displacements that vary along s: E_12 and E_23 are compatible, since a tied one would leave mechanisms.
    E_11, E_33 and E_13 are tied at these points in s. docs/theory, 2.11

    Parameters
    ----------
    made : Element
        The element for any deformation.
    """
    width_points = made.surface_points - 1
    across = tuple(float(s) for s in _core.gauss(width_points)[0])
    return replace(
        made,
        width_points=width_points,
        tying=tuple(replace(row, s=across) for row in made.tying if row.component not in _ZERO),
        modes=uniform_modes(made.modes),
        options={**made.options, "plane_strain": True},
    )


def uniform_modes(modes: Sequence[Mode]) -> tuple[Mode, ...]:
    """Modes on the line s = 0 of the strains that are not zero; modes that vanish there are left out."""
    on_line = ([part for part in mode.polynomials if part.b == 0 and part.component not in _ZERO] for mode in modes)
    return tuple(Mode.of(parts) for parts in on_line if parts)
