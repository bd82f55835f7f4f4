"""Laws of sheet metals from measurements: files read and checked, constants fitted, decks, code and pictures."""

from umform.calibration.calibrate import Calibration, calibrate
from umform.calibration.measurements import Measurements, read_cycles, read_directions, read_tension

__all__ = ["Calibration", "Measurements", "calibrate", "read_cycles", "read_directions", "read_tension"]
