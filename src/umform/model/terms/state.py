"""The state at which a model is evaluated, and the converged state to which it can return."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model.terms.term import Tree

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """Everything that an evaluation depends on, besides the histories of the model.

    Poses of tools follow from the controls and the time. Controls have names, so that a state can be evaluated with
    another model of the same structure.

    Attributes
    ----------
    x : ndarray, shape (3 n + k,)
        Displacement, followed by the scalar unknowns.
    time : float
        Time.
    controls : mapping of str to float
        Value of each control, including those that scalar unknowns move.
    since : float
        Time of the converged state whose histories the evaluation continues.

    Examples
    --------
    The residual of a strip whose tip is prescribed, before any step:

    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> load = model.traction("x1", (0.0, 0.0, 1.0), "load")
    >>> evaluation = model.evaluate(model.state.toward({"load": 2.0}))
    >>> float(evaluation.controls[load]), load.value
    (2.0, 0.0)
    """

    x: Floats
    time: float
    controls: Mapping[str, float]
    since: float

    def toward(self, controls: Mapping[str, float], time: float | None = None) -> Self:
        """The same unknowns with new values of some controls, by their names, and at another time.

        Raises
        ------
        InvalidValue
            The model had no control of a name, or a value is not finite.
        """
        if not isinstance(controls, Mapping):
            raise InvalidValue(
                "new values of controls have their names",
                where="toward",
                value=controls,
                cause="a value or a name alone",
                remedy="state.toward({'punch': -2.0})",
            )
        for name, value in controls.items():
            if name not in self.controls or not (isinstance(value, int | float | np.number) and math.isfinite(value)):
                raise InvalidValue(
                    "a state has finite values of the controls of its model",
                    where=f"control {name}",
                    value=value,
                    cause="" if name in self.controls else "another name, or the control in place of its name",
                    remedy=f"one of {', '.join(self.controls)}" if self.controls else "the model has no control",
                )
        return replace(self, controls={**self.controls, **controls}, time=self.time if time is None else time)


@dataclass(frozen=True)
class Snapshot:
    """A converged state to which a model can be restored.

    Poses of tools follow from the controls, the scalar unknowns and the time.

    Attributes
    ----------
    u : ndarray, shape (3 n,)
        Displacement.
    time, began : float
        Time at the end and at the beginning of its increment.
    controls : dict of str to float
        Value of each control, by its name.
    unknowns : dict of str to float
        Value of each scalar unknown, by its name.
    terms : dict of str to Tree
        History of each term that has one, by its key.
    supports : dict of str to Tree
        For each removed or removable support: whether it is active, its base displacement, and the replacing forces.
    """

    u: Floats
    time: float = 0.0
    controls: dict[str, float] = field(default_factory=dict)
    unknowns: dict[str, float] = field(default_factory=dict)
    terms: dict[str, Tree] = field(default_factory=dict)
    supports: dict[str, Tree] = field(default_factory=dict)
    began: float = 0.0
