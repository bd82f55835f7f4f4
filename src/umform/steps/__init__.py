"""What a run does: move controls, release them, follow a path of equilibria."""

from umform.steps.arc_length.arc import Arc
from umform.steps.move import Move
from umform.steps.release import Release

Step = Move | Release | Arc

__all__ = ["Arc", "Move", "Release", "Step"]
