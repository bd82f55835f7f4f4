"""Options of Newton's method, and increments, of sheets that are drawn over the radii of tools."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from umform.analysis.newton.options import NewtonOptions
    from umform.analysis.steps import Pace


def drawing_options() -> NewtonOptions:
    """Tolerances of drawing: what one increment leaves over is a force of the next. Tighter ones change no number."""
    from umform.analysis.newton.options import NewtonOptions

    return NewtonOptions(residual=1e-3, increment=1e-2, keep=True)


def usual_pace() -> Pace:
    """Increments that follow from what changes."""
    from umform.analysis.steps import Pace

    return Pace()


def solution_keys(options: NewtonOptions) -> dict[str, Any]:
    """Table of the options of Newton's method in a deck."""
    return {name: value for name, value in asdict(options).items() if value is not None}


def solution_texts(newton: NewtonOptions, pace: Pace) -> dict[str, str]:
    """Options and pace as text, by the names of the parameters."""
    return {
        name: ", ".join(f"{key.replace('_', ' ')} {value:g}" for key, value in vars(given).items() if value is not None)
        for name, given in {"newton": newton, "pace": pace}.items()
    }
