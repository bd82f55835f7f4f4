"""Shadows of a run: the same problem with one parameter changed a little, on the path of the run. docs/theory, 5.17"""

from umform.analysis.shadows.group import Shadowed, resume_with_shadows, solve_with_shadows
from umform.analysis.shadows.stages import of_all, solve_stages_with_shadows

__all__ = ["Shadowed", "of_all", "resume_with_shadows", "solve_stages_with_shadows", "solve_with_shadows"]
