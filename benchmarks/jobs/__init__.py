"""Random jobs such as users give: each is drawn from its number alone, and is the same on every machine."""

from jobs.bends import BENDS
from jobs.lot import Done, Job, Lot

__all__ = ["BENDS", "Done", "Job", "Lot"]
