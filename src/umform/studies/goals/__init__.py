"""Parameters for wanted results: strokes, forces and tools that compensate springback. docs/goals.md"""

from umform.studies.goals.compensate import compensate
from umform.studies.goals.found import Compensated, Trial, Wanted
from umform.studies.goals.shape import CompensatedShape, ShapeTrial, compensate_shape

__all__ = ["Compensated", "CompensatedShape", "ShapeTrial", "Trial", "Wanted", "compensate", "compensate_shape"]
