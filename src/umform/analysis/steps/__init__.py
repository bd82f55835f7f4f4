"""Steps of a run: move controls, release them, close and open tools, remove supports, arc length."""

from umform.analysis.steps.arc_length.arc import Arc
from umform.analysis.steps.close import Close
from umform.analysis.steps.free import Free
from umform.analysis.steps.move import Move
from umform.analysis.steps.pace import Pace
from umform.analysis.steps.release import Release

Step = Move | Release | Arc | Free | Close

__all__ = ["Arc", "Close", "Free", "Move", "Pace", "Release", "Step"]
