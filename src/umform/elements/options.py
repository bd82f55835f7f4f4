"""Options of an element of the catalogue, and its points through the thickness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from annotated_types import Ge, Le

from umform.elements.through_thickness import MOST_POINTS
from umform.spec import About, check_fields, parameters


@dataclass(frozen=True)
class ElementOptions:
    """Options of an element that the literature leaves open."""

    thickness_modes: Literal[1, 4, 9] | None = None
    """Number of enhanced modes of E_33 linear in t; default 4 (8 nodes) or 9 (18 nodes, there only)."""
    thickness_order: Annotated[int, Ge(1), Le(MOST_POINTS - 1)] | None = None
    """Order of the thickness strain in t; the literature has 1. Default: with a plastic law the complete order, the
    number of thickness points minus one; else 1, but 4 with BEND8 and BEND18."""
    order_modes: Literal[1, 4, 9] | None = None
    """Number of polynomials in the surface for each order above 1; default 1 (8 nodes) or 9 (18 nodes)."""
    membrane_modes: Literal[4, 5, 7] | None = None
    """Number of enhanced in-plane modes of EAS3DEAS; default 7."""
    tie_E33: bool | None = None
    """Tie E_33 at the corners (18 nodes: at the nodes) against curvature-thickness locking; BEND8 and BEND18 do."""
    compatible_E12: bool | None = None
    """Omit the tying of E_12 in MI9K3DEAS or BEND18."""
    plane_strain: bool | None = None
    """Fewer Gauss points in s, for cells that do not move along s and whose displacements do not vary along s: a strip
    of one element whose nodes are all held across it; same results."""

    def __post_init__(self) -> None:
        check_fields(self)

    def of_element(self) -> dict[str, Any]:
        """The given options of the element."""
        options = {name: getattr(self, name) for name in parameters(ElementOptions)}
        return {name: value for name, value in options.items() if value is not None}


@dataclass(frozen=True)
class BodyOptions(ElementOptions):
    """Options of the element, and its points through the thickness."""

    thickness_points: (
        Annotated[int, Ge(2), Le(MOST_POINTS), About(cause="a fraction, or the points of all layers")] | None
    ) = None
    """Points through the thickness, at least thickness_order + 1. Default: those of the law, if it names a number; else
    2 with an elastic law, the ``plastic_points`` of the element with a plastic one (any law with a history): 12 in each
    of 2 x 2 columns, 18 of 3 x 3, 20 with ``plane_strain`` and 8 nodes, 5 without an enhanced thickness strain. With a
    plastic law the thickness order of an element that is ``complete`` is then the number of points minus one, see
    :class:`umform.Element`."""
    thickness_rule: Literal["gauss", "lobatto", "split", "graded", "staggered"] | None = None
    """Quadrature rule, see :func:`umform.elements.thickness_rule`; default staggered where the default number of points
    of a plastic law applies and the element has an enhanced thickness strain, else gauss."""
