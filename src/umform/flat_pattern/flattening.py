"""The flat pattern of a part with all of its checks, and an order of its bends."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from umform.errors import DrawingError, InvalidValue
from umform.flat_pattern.allowance import AllowanceProvider, DeductionTable
from umform.flat_pattern.checks import holes_near_bends, overlap, shortest_flange
from umform.flat_pattern.order import Orders
from umform.flat_pattern.pattern import FlatPattern, pattern_of
from umform.flat_pattern.tooling import ComputedBends, Tooling
from umform.io.store import Store
from umform.problem.metal_file import metal_of
from umform.processes.bend_sequence.spec import Bodies
from umform.spec import check_arguments
from umform.surfaces.cad.read_solid import DEVIATION

#: Part of the inside radius of the drawing by which that of an air bend differs without a warning.
_RADIUS = 0.25


def flat(
    path: str | Path,
    *,
    metal: str | None = None,
    allowance: AllowanceProvider | None = None,
    tooling: Tooling | None = None,
    bodies: Bodies | None = None,
    store: Store | None = None,
    deviation: float = DEVIATION,
) -> FlatPattern:
    """The flat pattern of the sheet-metal part of a STEP file, and an order of its bends.

    Needs OpenCASCADE and ezdxf: `pip install "umform[cad]"`. A bend that is not in the store is run.

    Parameters
    ----------
    path : str or Path
        The file, with one solid; its unit is converted to mm.
    metal : str, optional
        Name in the library of sheet metals, for computed allowances.
    allowance : callable, optional
        Gives the flat length of a bend from bend angle in degrees, inside radius and thickness in mm, in place of
        computed bends: a `KFactor`, an `AllowanceTable`, or a function of your own.
    tooling : Tooling, optional
        Tools and mesh; default: dies by the radius of the drawing.
    bodies : Bodies, optional
        Bodies of the tools, for collisions.
    store : Store, optional
        Where computed bends are kept; default: that of the user.
    deviation : float
        Largest distance in mm of polylines from curves that are no lines and arcs.

    Returns
    -------
    FlatPattern

    Raises
    ------
    FileProblem
        If the file cannot be read.
    DrawingError
        If the part is no bent sheet of one thickness of flat faces and cylindrical bends; the message names the face.
    InvalidValue
        If neither a metal nor an allowance is given, the tools do not bend to an angle, or the allowance is a table of
        another metal or die.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.flat_pattern import KFactor
    >>> uf.flat("bracket.step", allowance=KFactor(0.44)).size  # doctest: +SKIP
    """
    check_arguments(flat, path=path, metal=metal, allowance=allowance, tooling=tooling, bodies=bodies, store=store)
    if metal is None and tooling is None and allowance is None:
        raise InvalidValue(
            "nothing says how long a bend is in the flat",
            where="flat",
            cause="neither a metal nor an allowance is given",
            remedy='metal="DC04" for computed bends, or allowance=KFactor(0.44)',
        )
    tooling = tooling or Tooling()
    tooling = tooling if metal is None else replace(tooling, metal=metal)
    if isinstance(allowance, DeductionTable):
        allowance = allowance.of("" if tooling.metal is None else metal_of(tooling.metal).name, tooling.opening)
    pattern = pattern_of(path, allowance or ComputedBends(tooling, store), deviation=deviation)
    at = overlap(pattern)
    if at is not None:
        raise DrawingError(
            "the flat pattern overlaps itself",
            where=str(path),
            value=f"contours cross at {at[0]:.2f}, {at[1]:.2f} of the pattern",
            cause="flanges that need the same metal",
            remedy="shorten a flange, give the corner a relief, or make the part of two pieces",
        )
    orders = Orders(pattern, tooling, bodies or Bodies())
    order, reasons = orders.find()
    remarks = [*pattern.warnings, *holes_near_bends(pattern), *_radii(pattern), *_short(pattern, orders), *reasons]
    notes = dict.fromkeys(note for bend in pattern.bends for note in bend.allowance.notes)
    return replace(pattern, warnings=(*remarks, *notes), order=order)


def _radii(pattern: FlatPattern) -> list[str]:
    """Warnings of inside radii that differ from the drawing, those of equal bends in one."""
    found = dict[tuple[float, float], list[str]]()
    for bend in pattern.bends:
        if abs(bend.allowance.radius - bend.radius) > _RADIUS * bend.radius:
            found.setdefault((bend.radius, round(bend.allowance.radius, 3)), []).append(str(bend.number))
    return [
        f"bends {', '.join(numbers)}: the die gives an inside radius of {made:.3g} mm, not the {drawn:.3g} mm of the "
        "drawing; the outer lengths are those of the drawing"
        for (drawn, made), numbers in found.items()
    ]


def _short(pattern: FlatPattern, orders: Orders) -> list[str]:
    found = []
    for bend in pattern.bends:
        case = orders.case(bend)
        least, shortest = case.reach + case.thickness, shortest_flange(pattern, bend)
        if shortest < least:
            found.append(
                f"bend {bend.number}: its shortest flat flange is {shortest:.4g} mm; a die of opening "
                f"{case.opening:g} needs {least:.4g} mm: a narrower die, or a longer flange"
            )
    return found
