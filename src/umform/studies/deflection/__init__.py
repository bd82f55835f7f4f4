"""Angle along a long bend, from the deflection of the ram and the bed of its press brake. docs/air-bending.md"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.studies.deflection.along import AngleAlong, angle_along
    from umform.studies.deflection.beam import beam_deflection
    from umform.studies.deflection.press_brake import PressBrake

__all__ = ["AngleAlong", "PressBrake", "angle_along", "beam_deflection"]

_HOME = {"AngleAlong": "along", "PressBrake": "press_brake", "angle_along": "along", "beam_deflection": "beam"}

__getattr__ = at_first_use(__name__, _HOME)
