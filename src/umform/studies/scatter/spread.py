"""Spread of one result: mean, standard deviation, shares of the sources, capability."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.results.quantity import Band, Quantity
from umform.studies.scatter.limits import Limits
from umform.studies.scatter.second_run import STEPS, SecondRun
from umform.studies.scatter.source import Source

Floats = NDArray[np.float64]
#: Standard deviation relative to the value that is round-off.
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Spread:
    """Spread of one result.

    Attributes
    ----------
    response : Quantity
        The result with its value in the run.
    mean, deviation : Quantity
        Mean and standard deviation; with a second run, their bands are the changes by the curvature that it has found.
    shares : dict of str to Quantity
        Share of each source in the variance in per cent, by its path. With correlations a share is that of the
        covariance with the result; it may be negative.
    limits : Limits, optional
        Its limits.
    """

    response: Quantity
    mean: Quantity
    deviation: Quantity
    shares: Mapping[str, Quantity]
    limits: Limits | None = None

    @classmethod
    def of(
        cls,
        response: Quantity,
        slopes: Floats,
        sources: Sequence[Source],
        covariance: Floats,
        limits: Limits | None = None,
    ) -> Spread:
        """The spread that follows from the derivatives of a result with respect to the sources."""
        deviation = _deviation(slopes, covariance)
        parts = slopes * (covariance @ slopes)
        scatters = deviation > _ROUND_OFF * abs(response.value or 0.0)
        shares = 100.0 * parts / parts.sum() if scatters else np.full(len(parts), math.nan)
        mean = replace(response, limit=None, band=None, hint="")
        label = f"standard deviation of {response.label}"
        return cls(
            response,
            mean,
            replace(mean, label=label, decimals=None, digits=3, value=deviation),
            {
                one.path: Quantity(f"share of {one.path}", "%", 1, value=float(share))
                for one, share in zip(sources, shares, strict=True)
            },
            limits,
        )

    def checked(self, run: SecondRun, slopes: Floats, covariance: Floats) -> Spread:
        """The same with bands: the changes by the curvature over the source of a second run."""
        change = run.change(self.name)
        if change is None or self.deviation.value is None:
            return self
        predicted, found = change
        secant = slopes.copy()
        secant[list(self.shares).index(run.path)] += (found - predicted) / run.step
        error = abs(_deviation(secant, covariance) - self.deviation.value)
        return replace(
            self,
            mean=replace(self.mean, band=Band(abs(found - predicted) / STEPS**2, run.title)),
            deviation=replace(self.deviation, band=Band(error, run.title)),
        )

    @property
    def name(self) -> str:
        """Name of the result."""
        return self.response.name

    @property
    def largest(self) -> str | None:
        """Path of the source with the largest share; None if nothing is known to have an effect."""
        known = {path: abs(one.value) for path, one in self.shares.items() if one.value is not None}
        return max(known, key=lambda path: known[path]) if known else None

    @property
    def capability(self) -> list[Quantity]:
        """Cp and Cpk, and the part of a normal distribution beyond the limits; empty without limits."""
        mean, deviation = self.mean.value, self.deviation.value
        if self.limits is None or mean is None:
            return []
        at = (mean, math.nan if deviation is None else deviation)
        outside = self.limits.outside(*at)
        return [
            Quantity("Cp", decimals=2, value=self.limits.cp(at[1])),
            Quantity("Cpk", decimals=2, value=self.limits.cpk(*at)),
            Quantity("beyond the limits", "%", 4, value=None if outside is None else 100.0 * outside),
        ]

    @property
    def quantities(self) -> list[Quantity]:
        """All numbers; their names begin with that of the result."""
        numbers = {"mean": self.mean, "deviation": self.deviation}
        numbers |= {f"share.{path}": one for path, one in self.shares.items()}
        numbers |= {one.label.replace(" ", "_").lower(): one for one in self.capability}
        return [
            replace(one, name=f"{self.name}.{end}", label=one.label if end == "deviation" else f"{end} of {self.name}")
            for end, one in numbers.items()
        ]


def _deviation(slopes: Floats, covariance: Floats) -> float:
    return float(np.sqrt(np.maximum(slopes @ covariance @ slopes, 0.0)))
