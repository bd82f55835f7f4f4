"""Laws of sheet metals from measurements: files read and checked, constants fitted, decks, code and pictures."""

from umform.studies.calibration.calibrate import Calibration, calibrate
from umform.studies.calibration.measurements import (
    Measurements,
    read_cycles,
    read_directions,
    read_tension,
    read_unloading,
)

__all__ = [
    "Calibration",
    "Measurements",
    "calibrate",
    "read_cycles",
    "read_directions",
    "read_tension",
    "read_unloading",
]
