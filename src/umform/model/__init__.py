"""The discrete model: mesh, bodies, supports, loads and tools; residual and tangent at a state."""

from umform._core import Connectivity
from umform.model.body import Body
from umform.model.evaluation import Evaluation
from umform.model.model import Model
from umform.model.nodal_term import NodalTerm
from umform.model.state import Snapshot, State
from umform.model.system import System
from umform.model.term import Term
from umform.model.tool import Tool

__all__ = ["Body", "Connectivity", "Evaluation", "Model", "NodalTerm", "Snapshot", "State", "System", "Term", "Tool"]
