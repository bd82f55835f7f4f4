"""Search for the density of the staggered heights (docs/theory/2-elements.md, section 2.10).

    python tools/staggered_points.py

All columns of an element together are the rule of a section. For 2 x 2 columns, three in a row and two in a row, of the
default number of points, the largest error of the permanent set of mild bends (tools/graded_points.py) must stay within
3 %; of the densities 1 + a t^p that keep it, the one with the least error of the stretch of the middle fibre in bends
under a given tension is taken: 0.2 to 0.7 of the yield force, curvatures of 3 to 60 times that of first yield.
"""

from __future__ import annotations

import numpy as np
from graded_points import Floats, Rule, Sheet, narrow, wide

from umform import _core
from umform.elements.staggered import default_points, phases, staggered_halves

#: Columns that stand in a section: the shares of 3 x 3 in each row are those of three.
_SURFACES = ((2, 2), (3, 1), (2, 1))
_WITHIN = 0.03


class Pulled:
    """Stretches of the middle fibre of bends under tension: exact, and by a rule."""

    def __init__(self, law: Rule) -> None:
        self.law = law
        curvatures, tensions = np.geomspace(3.0, 60.0, 24), np.linspace(0.2, 0.7, 11)
        self.k, self.T = (grid.ravel() for grid in np.meshgrid(curvatures, tensions, indexing="ij"))
        fibres = 4000
        self.exact = self.stretch(((np.arange(fibres) + 0.5) / fibres, np.full(fibres, 1.0 / fibres)))

    def stretch(self, rule: Rule) -> Floats:
        """Strains of the middle fibre at which the mean stress is the tension, by bisection."""
        t, w = np.concatenate([-rule[0], rule[0]]), 0.5 * np.concatenate([rule[1], rule[1]])
        low, high = np.zeros_like(self.k), self.k + 2.0
        for _ in range(45):
            middle = 0.5 * (low + high)
            strain = middle[:, None] + self.k[:, None] * t
            below = (np.sign(strain) * np.interp(np.abs(strain), *self.law)) @ w < self.T
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return 0.5 * (low + high)

    def error(self, rule: Rule) -> float:
        """Largest error of the stretch."""
        return float(np.abs(self.stretch(rule) / self.exact - 1.0).max())


def half_section(surface: tuple[int, int], density: tuple[float, float]) -> Rule:
    """The heights of all columns on [0, 1], with the shares that they have in a section."""
    t, w = staggered_halves(phases(surface), default_points(surface) // 2, density)
    along, across = (0.5 * _core.gauss(count)[1] for count in surface)
    return t.ravel(), (w * np.outer(across, along).ravel()[:, None]).ravel()


def main() -> None:
    """Search and print."""
    sheets = [Sheet(wide(0.0095), 6.0), Sheet(wide(0.05), 6.0), Sheet(narrow(0.0095), 3.0)]
    pulled = [Pulled(wide(hardening)) for hardening in (0.0095, 0.02)]
    found = []
    for a in (0.3, 0.4, 0.5, 0.6, 0.8, 1.0):
        for p in (3, 4, 5, 6, 7, 8):
            rules = [half_section(surface, (a, p)) for surface in _SURFACES]
            mild = [max(float(np.abs(part).max()) for sheet in sheets for part in sheet.errors(r)) for r in rules]
            stretch = [max(section.error(r) for section in pulled) for r in rules]
            found.append((max(stretch) if max(mild) < _WITHIN else np.inf, a, p, mild, stretch))
    for _, a, p, mild, stretch in sorted(found)[:4]:
        print(f"density 1 + {a:g} t^{p}")
        for surface, of_set, of_stretch in zip(_SURFACES, mild, stretch, strict=True):
            print(f"  {surface}: permanent set {100 * of_set:.2f} %, stretch under tension {100 * of_stretch:.2f} %")


if __name__ == "__main__":
    main()
