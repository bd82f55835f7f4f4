"""The discrete model: mesh, bodies, supports, loads and tools; residual and tangent at a displacement."""

from umform._core import Connectivity
from umform.model.body import Body
from umform.model.evaluation import Evaluation
from umform.model.model import Model
from umform.model.nodal_term import NodalTerm
from umform.model.state import Snapshot
from umform.model.term import Term
from umform.model.tool import Tool

__all__ = ["Body", "Connectivity", "Evaluation", "Model", "NodalTerm", "Snapshot", "Term", "Tool"]
