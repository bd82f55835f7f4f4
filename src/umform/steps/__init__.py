"""What a run does: move controls, release them, free supports, follow a path of equilibria."""

from umform.steps.arc_length.arc import Arc
from umform.steps.free import Free
from umform.steps.move import Move
from umform.steps.pace import Pace
from umform.steps.release import Release

Step = Move | Release | Arc | Free

__all__ = ["Arc", "Free", "Move", "Pace", "Release", "Step"]
