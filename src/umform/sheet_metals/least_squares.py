"""Constants from measurements by least squares, and their uncertainties."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, UmformError

Floats = NDArray[np.float64]
Law = TypeVar("Law")

#: Residual for constants that define no valid law.
_REFUSED = 1e3
#: A constant is not determined if its standard deviation is more than this part of it.
_VAGUE = 0.5
#: Two constants are not determined separately if their correlation is beyond this.
_TIED = 0.95


@dataclass(frozen=True)
class Fit(Generic[Law]):
    """A fitted law.

    Attributes
    ----------
    law : object
        The law.
    constants : mapping of str to float
        Fitted constants.
    deviations : mapping of str to float
        Standard deviation of each, from the scatter of the measurements; infinite if they do not determine it.
    misfit : float
        Root of the mean square of the residuals.
    correlation : ndarray, shape (n, n)
        Correlations of the constants, in their order; zero where a constant is not determined at all.
    sizes : mapping of str to float
        Size of a constant that may be zero, in place of its value if that is smaller.
    """

    law: Law
    constants: Mapping[str, float]
    deviations: Mapping[str, float]
    misfit: float
    correlation: Floats = field(default_factory=lambda: np.eye(0), compare=False)
    sizes: Mapping[str, float] = field(default_factory=dict)

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Constants whose standard deviation is more than half of their value, or of their size."""
        sizes = {name: max(abs(value), self.sizes.get(name, 0.0)) for name, value in self.constants.items()}
        return tuple(name for name, size in sizes.items() if not self.deviations[name] <= _VAGUE * size)

    @property
    def tied(self) -> tuple[tuple[str, str, float], ...]:
        """Pairs of constants that are not determined separately, with their correlation."""
        names = list(self.constants)
        pairs = np.argwhere(np.triu(np.abs(self.correlation) > _TIED, 1))
        return tuple((names[i], names[j], float(self.correlation[i, j])) for i, j in pairs)

    def __str__(self) -> str:
        lines = [f"{self.law}", f"misfit {self.misfit:.3g}"]
        lines += [f"{name} = {value:.6g} +- {self.deviations[name]:.2g}" for name, value in self.constants.items()]
        if self.undetermined:
            lines.append(f"not determined: {', '.join(self.undetermined)}")
        lines += [f"correlation of {first} and {second}: {c:.3f}" for first, second, c in self.tied]
        return "\n".join(lines)


def fit(
    build: Callable[[Mapping[str, float]], Law],
    residuals: Callable[[Law], Floats],
    start: Mapping[str, float],
    *,
    positive: bool,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    tolerance: float = 1e-8,
) -> Fit[Law]:
    """Find the constants with the least sum of squares.

    Parameters
    ----------
    build : callable
        Makes the law from constants.
    residuals : callable
        Differences between a law and the measurements, each over its uncertainty or scale.
    start : mapping of str to float
        First guess, by name.
    positive : bool
        Constants are positive and of unknown magnitude: their logarithms are varied.
    bounds : mapping of str to pairs of float, optional
        Lower and upper bounds of some of them; one that ends there is not determined.
    tolerance : float
        Relative change of the sum of squares, and of the constants, at which the search ends.

    Raises
    ------
    InvalidValue
        If the first guess or the result define no valid law.
    """
    names, guess = list(start), np.array(list(start.values()), dtype=float)
    if positive and not (guess > 0).all():
        raise InvalidValue(
            "the first guess of a positive constant must be positive",
            where="fit",
            value=dict(start),
            cause="a zero",
            remedy="a small number in place of zero",
        )
    build(start)  # raises the error of the law

    def constants(x: Floats) -> dict[str, float]:
        return dict(zip(names, (guess * np.exp(x) if positive else guess + x).tolist(), strict=True))

    sample = residuals(build(start))

    def differences(x: Floats) -> Floats:
        try:
            return residuals(build(constants(x)))
        except UmformError:  # an invalid law, or a state that cannot be reached
            return np.full_like(sample, _REFUSED)

    from scipy.optimize import least_squares  # the import is slow

    free = (0.0 if positive else -np.inf, np.inf)
    low, high = np.array([(bounds or {}).get(name, free) for name in names]).T
    with np.errstate(divide="ignore"):
        ends = (np.log(low / guess), np.log(high / guess)) if positive else (low - guess, high - guess)
    found = least_squares(
        differences,
        np.zeros(len(names)),
        bounds=ends,
        x_scale=0.1,
        method="trf",
        diff_step=1e-6,
        ftol=tolerance,
        xtol=tolerance,
    )
    values = constants(found.x)
    residual = np.asarray(found.fun)
    variance = float(residual @ residual) / max(len(residual) - len(names), 1)
    spread, correlation = uncertainty(np.asarray(found.jac), variance)
    spread = np.where(found.active_mask != 0, np.inf, spread)
    if positive:
        spread = spread * np.array(list(values.values()))
    misfit = float(np.sqrt(np.mean(found.fun**2)))
    return Fit(build(values), values, dict(zip(names, spread.tolist(), strict=True)), misfit, correlation)


def uncertainty(jacobian: Floats, variance: float) -> tuple[Floats, Floats]:
    """Standard deviations, infinite along undetermined directions, and correlations, eq. (3.141).

    Parameters
    ----------
    jacobian : ndarray, shape (m, n)
        Derivatives of the residuals.
    variance : float
        Variance of a residual.
    """
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    blind = sizes < 1e-6 * sizes.max(initial=1e-300)
    inverse = np.where(blind, 0.0, 1.0 / np.where(blind, 1.0, sizes))
    rows = directions * inverse[:, None]
    covariance = rows.T @ rows
    sides = np.sqrt(np.diag(covariance))
    hidden = (np.abs(directions[blind]) > 1e-3).any(axis=0) | (sides == 0.0)
    scale = np.where(hidden, np.inf, sides)
    correlation = covariance / np.outer(scale, scale)
    np.fill_diagonal(correlation, 1.0)
    return np.where(hidden, np.inf, np.sqrt(variance) * sides), correlation
