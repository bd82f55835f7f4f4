"""Shadows of a run: the same problem with one parameter changed a little, on the path of the run. docs/theory, 5.17"""

from umform.analysis.shadows.group import Shadowed, solve_with_shadows

__all__ = ["Shadowed", "solve_with_shadows"]
