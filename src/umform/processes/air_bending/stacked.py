"""Results of each of several sheets that are bent at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import edges_of_sheet, name_of
from umform.results.quantity import Band, Quantity, in_rows

Floats = NDArray[np.float64]
#: Ends of the names of the quantities of a sheet.
_NAMES = ("loaded_angle", "angle", "springback", "radius", "gap", "gap_in_the_middle")


@dataclass(frozen=True)
class SheetOfStack:
    """One of several sheets.

    Attributes
    ----------
    loaded, released : Section
        Its section under load and after unloading.
    gap, gap_in_the_middle : float or None
        After unloading, the largest distance from the sheet above, and that in the plane of symmetry; None of the
        last, and below a bonded one.
    """

    loaded: Section
    released: Section
    gap: float | None = None
    gap_in_the_middle: float | None = None


def stack_of(case: AirBending, result: Result, loaded: Floats) -> tuple[SheetOfStack, ...]:
    """The sheets of a bend from the die upwards, at its end and with displacements under load; none of a single one."""
    mesh, u = result.model.mesh, result.model.u
    edges = [edges_of_sheet(case, number) for number in range(len(case.sheets))] if case.on_top else []
    pairs = [(Section.of(mesh, loaded, edge), Section.of(mesh, u, edge)) for edge in edges]
    found = []
    for number, (under_load, released) in enumerate(pairs):
        free = number < len(case.on_top) and not case.on_top[number].bonded
        above = pairs[number + 1][1] if free else None
        gaps = (None, None) if above is None else gaps_of(released, above)
        found.append(SheetOfStack(under_load, released, *gaps))
    return tuple(found)


def gaps_of(below: Section, above: Section) -> tuple[float, float]:
    """Largest distance of two sheets over the length of the shorter, and their distance in the plane of symmetry.

    It is measured from the lower nodes of the sheet above, across the upper face of that below.
    """
    face, nodes = below.fibre(1.0), above.fibre(0.0)
    way = np.diff(face, axis=0)
    length = np.linalg.norm(way, axis=1)
    along, normal = way / length[:, None], np.stack([-way[:, 1], way[:, 0]], axis=1) / length[:, None]
    from_start = nodes[:, None] - face[:-1]
    at = np.einsum("nek,ek->ne", from_start, along)
    beside = np.maximum(np.maximum(-at, at - length), 0.0)
    across = np.einsum("nek,ek->ne", from_start, normal)
    nearest = np.hypot(beside, across).argmin(axis=1)
    rows = np.arange(len(nodes))
    over = (beside[rows, nearest] <= 1e-9 * length.sum()) | (np.hypot(beside, across).min(axis=1) < below.thickness)
    over &= ~((nearest == len(length) - 1) & (at[rows, nearest] > length[-1]))
    gaps = across[rows, nearest]
    return float(gaps[over].max()), float(nodes[0, 1] - face[0, 1])


def names_of_stack(case: AirBending) -> list[str]:
    """Names of the quantities of all sheets; none of a single one."""
    return [f"{name_of(number)}_{name}" for number in range(len(case.sheets)) if case.on_top for name in _NAMES]


def of_stack(number: int, sheet: SheetOfStack) -> list[Quantity]:
    """Quantities of a sheet, counted from 0."""
    loaded, released, own = sheet.loaded, sheet.released, f"{name_of(number)}_"
    radius = released.radius if released.is_bent else None
    return [
        Quantity("angle under load", "degrees", 2, name=f"{own}loaded_angle", value=loaded.angle),
        Quantity("angle", "degrees", 2, name=f"{own}angle", value=released.angle),
        Quantity("springback", "degrees", 2, name=f"{own}springback", value=released.angle - loaded.angle),
        Quantity("inside radius", "mm", 3, name=f"{own}radius", value=radius),
        Quantity("gap above", "mm", 3, name=f"{own}gap", value=sheet.gap),
        Quantity("in the middle", "mm", 3, name=f"{own}gap_in_the_middle", value=sheet.gap_in_the_middle),
    ]


def quantities_of_stack(stack: Sequence[SheetOfStack], bands: Mapping[str, Band] | None = None) -> list[Quantity]:
    """Quantities of all sheets, with their errors by name."""
    known = bands or {}
    return [
        replace(one, label=f"sheet {number + 1}: {one.label}", band=known.get(one.name))
        for number, sheet in enumerate(stack)
        for one in of_stack(number, sheet)
        if one.value is not None
    ]


def table_of_stack(stack: Sequence[SheetOfStack]) -> list[list[str]]:
    """The sheets in rows, from the die upwards; none of a single sheet."""
    rows = in_rows([of_stack(number, sheet) for number, sheet in enumerate(stack)])
    return [["sheet", *rows[0]], *([str(n), *row] for n, row in enumerate(rows[1:], 1))] if rows else []
