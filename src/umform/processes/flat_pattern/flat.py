"""The flat pattern of a part with all of its checks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from umform.errors import DrawingError
from umform.processes.flat_pattern.allowance import AllowanceProvider
from umform.processes.flat_pattern.checks import holes_near_bends, overlap
from umform.processes.flat_pattern.pattern import FlatPattern, pattern_of


def flat(path: str | Path, allowance: AllowanceProvider, *, deviation: float = 0.01) -> FlatPattern:
    """The flat pattern of the sheet-metal part of a STEP file.

    Needs OpenCASCADE: `pip install "umform[cad]"`.

    Parameters
    ----------
    path : str or Path
        The file, with one solid; its unit is converted to mm.
    allowance : callable
        Gives the flat length of a bend from bend angle in degrees, inside radius and thickness in mm: a `KFactor`, an
        `AllowanceTable`, or a function of your own.
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
    """
    pattern = pattern_of(path, allowance, deviation=deviation)
    at = overlap(pattern)
    if at is not None:
        raise DrawingError(
            "the flat pattern overlaps itself",
            where=str(path),
            value=f"contours cross at {at[0]:.2f}, {at[1]:.2f} of the pattern",
            cause="flanges that need the same metal",
            remedy="shorten a flange, give the corner a relief, or make the part of two pieces",
        )
    return replace(pattern, warnings=(*pattern.warnings, *holes_near_bends(pattern)))
