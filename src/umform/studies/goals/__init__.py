"""Parameters for wanted results: strokes, forces and tools that compensate springback. docs/goals.md"""

from umform.studies.goals.compensate import Compensated, Trial, Wanted, compensate

__all__ = ["Compensated", "Trial", "Wanted", "compensate"]
