"""Number of contact cells of a face, and the expected ripple of the force. docs/cells.md"""

from __future__ import annotations

import math

from umform.errors import InvalidValue
from umform.model.contact.encounter import Encounter

#: Default of the allowed ripple of the force.
RIPPLE = 1e-3
#: Smallest and largest number of cells per direction of a face.
FEWEST, MOST = 3, 20


def checked_cells(cells: int | str | None, ripple: float | None, where: str) -> int | str | None:
    """The given number of cells, "auto", or None for points.

    Raises
    ------
    InvalidValue
        If the number is invalid, or given together with a ripple.
    """
    if ripple is not None and cells != "auto":
        raise InvalidValue(
            "a ripple can be wanted only of cells whose number follows from it",
            where=where,
            value=f"ripple {ripple}, cells {cells}",
            remedy="cells='auto'",
        )
    if ripple is not None and not 0.0 < ripple < 1.0:
        raise InvalidValue("the allowed ripple is a fraction of the force below 1", where=where, value=ripple)
    if cells is None or cells == "auto":
        return cells
    if isinstance(cells, bool | str) or cells not in range(1, MOST + 1):
        raise InvalidValue(
            f"cells per direction of a face must be 1 to {MOST}, or 'auto'",
            where=where,
            value=cells,
            cause="a number of cells in all, or a word",
            remedy="3 on 4-node and 5 on 9-node faces to begin with",
        )
    return int(cells)


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
