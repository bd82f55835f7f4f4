"""Steps of a run: move controls, release them, close and open tools, remove supports, arc length."""

from umform.steps.arc_length.arc import Arc
from umform.steps.close import Close
from umform.steps.free import Free
from umform.steps.move import Move
from umform.steps.pace import Pace
from umform.steps.release import Release

Step = Move | Release | Arc | Free | Close

__all__ = ["Arc", "Close", "Free", "Move", "Pace", "Release", "Step"]
