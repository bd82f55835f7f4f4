"""Number of contact cells of a face, and the expected ripple of the force. docs/cells.md"""

from __future__ import annotations

import math

from umform.errors import InvalidValue
from umform.model.contact.encounter import Encounter

#: Default of the allowed ripple of the force.
RIPPLE = 1e-3
#: Smallest and largest number of cells per direction of a face.
FEWEST, MOST = 3, 20


def ripple_of(met: Encounter, cells: int, allowed: float) -> float:
    """Expected relative ripple of the force. eqs. (4.120), (4.121)

    Parameters
    ----------
    met : Encounter
        Sheet and tool.
    cells : int
        Cells along a face.
    allowed : float
        Penetration; it is also the radius assumed for an edge.
    """
    return (met.length / cells) ** 2 / (12.0 * max(met.radius, allowed) * met.thickness)


def cells_for(met: Encounter, ripple: float, touching: float, allowed: float) -> int:
    """Smallest number of cells that limits the ripple, with cells shorter than the contact. eq. (4.122)"""
    by_ripple = math.sqrt(ripple_of(met, 1, allowed) / ripple)
    by_length = met.length / touching if touching > 0.0 else MOST
    return min(max(math.ceil(by_ripple), math.ceil(by_length), FEWEST), MOST)


def refuse_points_and_cells(points: object, cells: object) -> None:
    """Refuse points and cells of one contact."""
    if points is not None and cells is not None:
        raise InvalidValue(
            "give points or cells, and not both",
            where="cells",
            value=f"points {points}, cells {cells}",
            cause="cells take the place of points",
            remedy="leave one of them out",
        )
