"""The discrete model: mesh, bodies, supports, loads and tools; residual and tangent at a state."""

from umform._core import Connectivity
from umform.model.bodies.body import Body
from umform.model.equations.evaluation import Evaluation
from umform.model.model import Model
from umform.model.system import System
from umform.model.terms.nodal_term import NodalTerm
from umform.model.terms.state import Snapshot, State
from umform.model.terms.term import Term
from umform.model.tools.tool import Tool

__all__ = ["Body", "Connectivity", "Evaluation", "Model", "NodalTerm", "Snapshot", "State", "System", "Term", "Tool"]
