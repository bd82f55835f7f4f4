"""What is solved: mesh, bodies, supports, loads and tools; residual and tangent at a displacement."""

from umform.model.body import Body
from umform.model.evaluation import Evaluation
from umform.model.model import Model
from umform.model.state import Snapshot
from umform.model.tool import Tool

__all__ = ["Body", "Evaluation", "Model", "Snapshot", "Tool"]
