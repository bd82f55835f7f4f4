"""Unknowns, pattern and scatter maps of a model, and what an evaluation gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.model.boundary import Pressure
from umform.model.ties import Unknowns
from umform.solvers import Pattern

if TYPE_CHECKING:
    from umform.model import Model

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Evaluation:
    """Residual and tangent at a displacement.

    Attributes
    ----------
    residual : ndarray, shape (3 n,)
        Internal and contact forces minus loads at all degrees of freedom; reactions at those that are held, prescribed
        or tied.
    values : ndarray
        Entries of the tangent over the unknowns, in the order of :attr:`Model.pattern`.
    predictor : ndarray, shape (3 n,)
        Tangent times the increment of the prescribed degrees of freedom, or rate of the residual at held unknowns; zero
        where neither was asked for.
    force_scale : float
        Root of the sum of squares of all element forces, the scale of a residual. eq. (5.8)
    failed : int
        First cell that has no residual, or -1.
    round_off : float
        What a relative error of all positions makes of the residual of contact, over that error. eq. (5.36)
    failure : str
        Why that cell has no residual, in words that follow its number: it is turned inside out, for instance.
    """

    residual: Floats
    values: Floats
    predictor: Floats
    force_scale: float
    failed: int
    round_off: float = 0.0
    failure: str = ""


@dataclass(frozen=True)
class Snapshot:
    """A converged state that a model can be put back to; of each contact it has the multipliers."""

    u: Floats
    state: Floats
    alpha: Floats
    controls: tuple[float, ...]
    time: float
    multipliers: tuple[Floats, ...] = ()


class Assembly:
    """Unknowns, pattern and scatter maps, made once for a set of supports, contacts and pressures."""

    def __init__(self, model: Model) -> None:
        constrained = model.constrained()
        pairs = np.concatenate([np.empty((0, 2), dtype=np.int32), *[tie.dofs for tie in model.ties]])
        constrained[pairs] = True
        free = np.flatnonzero(~constrained)
        if not model.ranks.any(len(free) + len(pairs) > 0):
            raise InvalidValue("all degrees of freedom are prescribed", remedy="leave some nodes free")
        self.unknowns = Unknowns(free, pairs, constrained.size)
        equation = np.full(constrained.size, -1, dtype=np.int32)
        equations = np.concatenate([free, *pairs.T])
        equation[equations] = np.arange(len(equations))
        pressures = [c.block for c in model.of_kind(Pressure) if c.block is not None]
        pattern = _core.Pattern(equation, [model.block.connectivity], symmetric=model.block.symmetric and not pressures)
        self.scatter = pattern.scatter(model.block.connectivity)
        self.contact_scatter = [pattern.scatter(contact.block.connectivity) for contact in model.contacts]
        self.pressure_scatter = [pattern.scatter(block.connectivity) for block in pressures]
        detailed = Pattern(len(equations), pattern.indptr.astype(np.int32), pattern.indices, pattern.symmetric)
        self.entries = detailed.nnz
        self.pattern, self._reduction = detailed, None
        if len(pairs):
            self.pattern, self._reduction = self.unknowns.reduction(detailed.rows, detailed.indices, detailed.symmetric)

    def reduce(self, values: Floats) -> Floats:
        """Entries over the unknowns from those over free and tied degrees of freedom. eq. (5.19)"""
        return values if self._reduction is None else self._reduction(values)
