"""Parts of a deck of CalculiX and its output: for the cases of the book and for the comparison of codes.

Keywords as in G. Dhondt, CalculiX CrunchiX User's Manual, version 2.20.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Displacement of the first step. CalculiX treats a penetration at the beginning of the first step as one of the mesh,
#: and removes it in proportion to the time of each step. Without a short first step the force at a displacement depends
#: on the stroke of the step.
FIRST = 0.01
#: Edges of a hexahedron in the order of its mid-side nodes.
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))


def numbers(ids: Iterable[int], a_line: int = 10) -> list[str]:
    """Numbers on lines of so many."""
    words = [str(number) for number in ids]
    return [",".join(words[i : i + a_line]) for i in range(0, len(words), a_line)]


def element(number: int, nodes: Sequence[int]) -> list[str]:
    """One element: at most 16 numbers on a line; one that goes on ends with a comma."""
    rows = numbers([number, *nodes], a_line=16)
    return [f"{row}," for row in rows[:-1]] + rows[-1:]


def node_set(name: str, ids: Iterable[int]) -> list[str]:
    """Set of nodes."""
    return [f"*NSET,NSET={name}", *numbers(ids)]


def metal(young: float, nu: float, flow: tuple[float, float] | None, elset: str) -> list[str]:
    """Material of an element set; with yield stress and hardening modulus, given up to a plastic strain of 5."""
    lines = ["*MATERIAL,NAME=STEEL", "*ELASTIC", f"{young:.9g},{nu:.9g}"]
    if flow is not None:
        yield_stress, modulus = flow
        lines += ["*PLASTIC", f"{yield_stress},0.", f"{yield_stress + 5 * modulus + 1e-6},5."]
    return [*lines, f"*SOLID SECTION,ELSET={elset},MATERIAL=STEEL"]


@dataclass(frozen=True)
class Ring:
    """Rigid cylinder along y: flat facets between two angles; a contact beyond them would be missed.

    Attributes
    ----------
    radius, x, z : float
        Radius and axis.
    between : tuple of float
        Angles from the x-axis, in degrees.
    facets : int
        Facets of the arc.
    width : float
        The sheet lies between y = 0 and this.
    """

    radius: float
    x: float
    z: float
    between: tuple[float, float] = (45.0, 145.0)
    facets: int = 400
    width: float = 1.0

    def lines(self, nodes: int, elements: int) -> tuple[list[str], tuple[int, int]]:
        """Lines of the tool after so many nodes and elements; the reference nodes, which both have to be held."""
        node, made = nodes, ["*NODE,NSET=NTOOL"]
        margin = 0.1 * self.width
        for angle in np.radians(np.linspace(*self.between, self.facets + 1)):
            for r in (self.radius, 0.8 * self.radius):
                for y in (-margin, self.width + margin):
                    node += 1
                    made.append(f"{node},{self.x + r * np.cos(angle):.9g},{y:.9g},{self.z + r * np.sin(angle):.9g}")
        held = node + 1, node + 2
        made += ["*NODE", *(f"{n},{self.x},0,{self.z}" for n in held), "*ELEMENT,TYPE=C3D8,ELSET=TOOL"]
        for i in range(self.facets):
            a = nodes + 4 * i
            b = a + 4
            corners = (a + 3, a + 4, b + 4, b + 3, a + 1, a + 2, b + 2, b + 1)
            made += element(elements + 1 + i, corners)
        made += [f"*RIGID BODY,NSET=NTOOL,REF NODE={held[0]},ROT NODE={held[1]}"]
        made += ["*MATERIAL,NAME=TOOL", "*ELASTIC", "210000,.3", "*SOLID SECTION,ELSET=TOOL,MATERIAL=TOOL"]
        return made, held


def contact_with_ring(touching: Iterable[int], penalty: float, friction: float = 0.0) -> list[str]:
    """Lower faces of elements against the ring: surface to surface, the pressure linear in the penetration.

    With friction the traction is linear in the slip up to its bound, by the penalty too.
    """
    lines = ["*SURFACE,NAME=SLOWER", *(f"{number},S1" for number in touching), "*SURFACE,NAME=STOOL", "TOOL,S2"]
    lines += ["*SURFACE INTERACTION,NAME=PENALTY", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR"]
    lines.append(f"{penalty},0.,0.01")
    if friction:
        lines += ["*FRICTION", f"{friction},{penalty}"]
    return [*lines, "*CONTACT PAIR,INTERACTION=PENALTY,TYPE=SURFACE TO SURFACE", "SLOWER,STOOL"]


def totals(printed: str) -> tuple[Floats, Floats]:
    """Times and total forces (k, 3) of the increments that a ``.dat`` file holds."""
    found = re.findall(r"total force.*time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", printed)
    table = np.array(found, dtype=float).reshape(-1, 4)
    return table[:, 0], table[:, 1:]
