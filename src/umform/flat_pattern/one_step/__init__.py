"""One-step estimate of a blank: the flat outline of a formed mid-surface, by an inverse method (theory, chapter 6)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.flat_pattern.one_step.case import Blank
    from umform.flat_pattern.one_step.correction import corrected_blank, distance_to_outline
    from umform.flat_pattern.one_step.estimate import BlankEstimate, blank
    from umform.flat_pattern.one_step.reading import mid_surface

__all__ = ["Blank", "BlankEstimate", "blank", "corrected_blank", "distance_to_outline", "mid_surface"]

_HOME = {
    "Blank": "case",
    "BlankEstimate": "estimate",
    "blank": "estimate",
    "corrected_blank": "correction",
    "distance_to_outline": "correction",
    "mid_surface": "reading",
}

__getattr__ = at_first_use(__name__, _HOME)
