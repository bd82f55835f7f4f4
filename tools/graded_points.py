"""Search for abscissae and weights of the graded rule (docs/theory/2-elements.md, section 2.10).

    python tools/graded_points.py 18 --seconds 60

Minimises the largest error of the permanent set over three families: a cantilever bent to 1.1 ... 1.46 times its yield
moment, a section bent to 1.12 ... 25 times its yield curvature, and one bent by 1.1 ... 1.5 times its yield moment;
for sheets that are wide (hardening modulus of 1 and 5 % of Young's) and narrow (1 %). Small strains: the stress at
the place t of a section of curvature k is that of the strain k t.

A minimax problem by linear programs in a trust region, from random starts.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

Floats = NDArray[np.float64]
Rule = tuple[Floats, Floats]

_NU = 0.3
#: Degree to which the rule is exact on each half.
_DEGREE = 3
#: Error of the laws but the first over that of the first.
_OTHERS = 0.95
#: Rising ones, dense near the first: there the error of a rule has sharp peaks.
_RISE = np.linspace(0.0, 1.0, 240) ** 2
_CURVATURES = np.concatenate([1.0 + 2.6 * np.linspace(0.0, 1.0, 1200) ** 1.5, np.geomspace(3.65, 60.0, 60)])


def wide(hardening: float) -> Rule:
    """Strain and stress along a sheet without strain across it, both over those of first yield."""
    x = np.concatenate([[0.0, 1.0], np.geomspace(1.0, 40.0, 4000)[1:]])
    stiffness = np.array([[1.0, _NU], [_NU, 1.0]]) / (1.0 - _NU**2)
    mises = np.array([[1.0, -0.5], [-0.5, 1.0]])
    first = 1.0 / np.sqrt(1.0 - _NU + _NU**2)
    stress, limit, found, before = np.zeros(2), 1.0, [], 0.0
    for strain in x:
        trial = stress + stiffness @ np.array([(strain - before) * first * (1.0 - _NU**2), 0.0])
        before, flow = strain, 0.0
        stress = trial
        for _ in range(40):  # stress = (I + flow C P)^-1 trial, on the yield surface
            over = np.sqrt(stress @ mises @ stress)
            gap = over * (1.0 - hardening * flow) - limit
            if gap < 1e-13:
                break
            inverse = np.linalg.inv(np.eye(2) + flow * stiffness @ mises)
            change = -(mises @ stress) @ (inverse @ stiffness @ mises @ stress) / over
            flow -= gap / (change * (1.0 - hardening * flow) - hardening * over)
            stress = np.linalg.solve(np.eye(2) + flow * stiffness @ mises, trial)
        limit += hardening * flow * np.sqrt(stress @ mises @ stress)
        found.append(stress[0] / first)
    return x, np.array(found)


def narrow(hardening: float) -> Rule:
    """The same of a strip that is free to contract across."""
    x = np.array([0.0, 1.0, 100.0])
    return x, np.array([0.0, 1.0, 1.0 + 99.0 * hardening / (1.0 + hardening)])


class Sheet:
    """The permanent sets of a law: exact, and by a rule."""

    def __init__(self, law: Rule, top_curvature: float) -> None:
        self.law = law
        t = (np.arange(4000) + 0.5) / 4000.0
        moments = self.moments(_CURVATURES, (t, np.full(4000, 1.0 / 4000.0)))
        first = float(np.interp(1.1, moments, _CURVATURES))
        self.bent = np.concatenate([first + (3.0 - first) * _RISE, np.geomspace(3.1, 25.0, 15)])
        self.bent_set = self.bent - np.interp(self.bent, _CURVATURES, moments)
        top = min(1.5, float(np.interp(top_curvature, _CURVATURES, moments)))
        self.by_moment = 1.1 + (top - 1.1) * _RISE
        self.moment_set = np.interp(self.by_moment, moments, _CURVATURES) - self.by_moment
        self.along = np.linspace(1.0, min(1.46, top), 150)
        self.tops = np.linspace(1.1, min(1.46, top), 25)
        self.tip_set = self._tip(moments)

    def moments(self, curvatures: Floats, rule: Rule) -> Floats:
        """Moments over that of first yield."""
        t, w = rule
        stress = np.interp(np.outer(curvatures, t), *self.law)
        return np.asarray(stress @ (w * t) / (w @ t**2))

    def _tip(self, moments: Floats) -> Floats:
        """Permanent deflections of a cantilever over its top moment. eq. (2.45)"""
        left = (np.interp(self.along, moments, _CURVATURES) - self.along) * self.along
        summed = np.concatenate([[0.0], np.cumsum(0.5 * (left[1:] + left[:-1]) * np.diff(self.along))])
        return np.asarray(np.interp(self.tops, self.along, summed))

    def errors(self, rule: Rule) -> tuple[Floats, Floats, Floats]:
        """Errors of the cantilever, at given curvatures, and at given moments."""
        moments = self.moments(_CURVATURES, rule)
        bent = (self.bent - self.moments(self.bent, rule)) / self.bent_set - 1.0
        by_moment = (np.interp(self.by_moment, moments, _CURVATURES) - self.by_moment) / self.moment_set - 1.0
        return self._tip(moments) / self.tip_set - 1.0, bent, by_moment


def _all_errors(sheets: list[Sheet], z: Floats) -> Floats:
    rule = z[: len(z) // 2], z[len(z) // 2 :]
    parts = [np.concatenate(sheet.errors(rule)) * (_OTHERS if n else 1.0) for n, sheet in enumerate(sheets)]
    return np.concatenate(parts)


def _exact(z: Floats) -> Floats:
    """The rule with the least change of its weights that makes it exact to the degree."""
    n = len(z) // 2
    powers = z[:n] ** np.arange(_DEGREE + 1)[:, None]
    missing = 1.0 / np.arange(1, _DEGREE + 2) - powers @ z[n:]
    return np.concatenate([z[:n], z[n:] + np.linalg.lstsq(powers, missing, rcond=None)[0]])


def minimise(sheets: list[Sheet], z: Floats, steps: int) -> tuple[float, Floats]:
    """Largest error, and the abscissae and weights on [0, 1] that a search from z ends at."""
    z, n, reach = _exact(z), len(z) // 2, 0.02
    best = np.inf if z[n:].min() <= 0.0 else float(np.abs(_all_errors(sheets, z)).max())
    for _ in range(steps):
        here = _all_errors(sheets, z)
        slopes = np.array([(_all_errors(sheets, z + d) - here) / 1e-6 for d in 1e-6 * np.eye(2 * n)]).T
        powers = np.arange(_DEGREE + 1)[:, None]
        kept = np.hstack([powers * z[:n] ** np.maximum(powers - 1, 0) * z[n:], z[:n] ** powers, np.zeros((4, 1))])
        order = np.hstack([(np.eye(n) - np.eye(n, k=1))[:-1], np.zeros((n - 1, n + 1))])
        one = np.ones((len(here), 1))
        above = np.vstack([np.hstack([slopes, -one]), np.hstack([-slopes, -one]), order])
        most = np.concatenate([-here, here, np.diff(z[:n]) - 0.01])
        least = np.concatenate([np.maximum(-reach, 0.005 - z[:n]), np.maximum(-reach, 0.004 - z[n:])])
        largest = np.concatenate([np.minimum(reach, 0.995 - z[:n]), np.full(n, reach)])
        bounds = [*zip(np.minimum(least, largest), largest, strict=True), (0.0, None)]
        cost = np.append(np.zeros(2 * n), 1.0)
        found = linprog(cost, A_ub=above, b_ub=most, A_eq=kept, b_eq=np.zeros(len(kept)), bounds=bounds)
        moved = _exact(z + found.x[:-1]) if found.status == 0 else z
        error = float(np.abs(_all_errors(sheets, moved)).max())
        better = error < best and moved[n:].min() > 0.0
        reach = min(1.5 * reach, 0.05) if better else 0.4 * reach
        if better:
            z, best = moved, error
        if reach < 1e-6:
            break
    return best, z


def start(n: int, random: np.random.Generator) -> Floats:
    """A rule whose points are as dense as (2.49) asks at a given moment, more or less."""
    t = np.linspace(0.0, 1.0, 2001)
    y = np.clip(t, random.uniform(0.3, 0.42), random.uniform(0.88, 0.95))
    density = np.cumsum(1.0 / np.sqrt((1.0 / y - 1.5 + 0.5 * y**2) * y**3))
    places = np.interp((np.arange(n) + random.uniform(0.3, 0.7)) / n, density / density[-1], t)
    ends = np.concatenate([[0.0], 0.5 * (places[1:] + places[:-1]), [1.0]])
    return np.concatenate([places, np.diff(ends)])


def main() -> None:
    """Search and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("points", type=int, help="number of points, even")
    parser.add_argument("--seconds", type=float, default=60.0, help="how long to search")
    parser.add_argument("--seed", type=int, default=1, help="of the random starts")
    given = parser.parse_args()
    n, random, begun = given.points // 2, np.random.default_rng(given.seed), time.monotonic()
    sheets = [Sheet(wide(0.0095), 6.0), Sheet(wide(0.05), 6.0), Sheet(narrow(0.0095), 3.0)]
    best, z = min((minimise(sheets[:1], start(n, random), 30) for _ in range(3)), key=lambda r: r[0])
    while time.monotonic() - begun < 0.5 * given.seconds:
        best, z = min((best, z), minimise(sheets[:1], start(n, random), 30), key=lambda r: r[0])
    best, z = minimise(sheets, z, 80)
    while time.monotonic() - begun < given.seconds:
        moved = z.copy()
        moved[:n] += random.choice([0.002, 0.006, 0.02]) * random.normal(size=n) * (1.05 - z[:n])
        moved[:n] = np.sort(np.clip(moved[:n], 0.02, 0.99))
        best, z = min((best, z), minimise(sheets, moved, 25), key=lambda r: r[0])
    rule = z[:n], z[n:]
    print("abscissae", np.round(rule[0], 4).tolist(), "weights", np.round(rule[1], 4).tolist())
    for name, sheet in zip(("wide, 1 %", "wide, 5 %", "narrow, 1 %"), sheets, strict=True):
        worst = (f"{100.0 * float(np.abs(part).max()):.2f}" for part in sheet.errors(rule))
        print(f"{name}: cantilever, to a curvature, by a moment: {', '.join(worst)} %")


if __name__ == "__main__":
    main()
