"""What is solved: mesh, element, material, supports, loads and tools; residual and tangent at a displacement."""

from umform.model.assembly import Evaluation, Snapshot
from umform.model.model import Model

__all__ = ["Evaluation", "Model", "Snapshot"]
