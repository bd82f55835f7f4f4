"""Each law in a small strip of each kind of element: Newton's method, its iterations beside J2, the balance of work."""

from __future__ import annotations

import math
from statistics import median

import umform as uf
from umform.materials import J2, Swift
from umform.materials.material import Material
from umform_book.case import Case
from umform_book.metals import CARDS, STEEL
from umform_book.page import Page
from umform_book.variants import Variant

KINDS = ("ANS3DEAS", "EAS3DEAS", "BEND8", "MI9K3DEAS", "BEND18")
#: Iterations over those of J2, median over the laws.
_MORE = 1.3


def strip(page: Page, label: str, kind: str, metal: Material) -> int:
    """Bend a strip and pull it, at 30 degrees to the rolling direction; its iterations."""
    cells = (4, 2) if Variant(kind).cell == "hex8" else (2, 1)
    body = uf.mesh.strip(length=8.0, width=4.0, thickness=1.0, cells=cells, cell=Variant(kind).cell)
    turn = math.radians(30.0)
    model = uf.Model(body, kind, material=metal, rolling=(math.cos(turn), math.sin(turn), 0.0))
    model.fix("x0")
    up, out = (model.prescribe("x1", axis, f"pull_{axis}") for axis in "zx")
    page.solve(label, model, [uf.Move(up, to=1.0, steps=8), uf.Move(out, to=0.3, steps=6)])
    page.at_most(f"{label}: increments cut", page.balances[-1].increments - 14.0, 0.0)
    return page.balances[-1].iterations


def run(page: Page) -> None:
    """Fill the page."""
    names = page.pick(list(CARDS), ["AA2090-T3 with Chaboche"])
    kinds = page.pick(KINDS, KINDS[:1])
    j2 = J2(**STEEL, hardening=Swift(500.0, 0.004, 0.21))
    rows: list[tuple[str | float | int, ...]] = []
    plain = {kind: strip(page, f"J2, {kind}", kind, j2) for kind in kinds}
    rows.append(("J2", *plain.values()))
    ratios = []
    for name in page.each(names):
        counts = {kind: strip(page, f"{name}, {kind}", kind, CARDS[name]) for kind in kinds}
        ratios += [counts[kind] / plain[kind] for kind in kinds]
        rows.append((name, *counts.values()))
    page.table("Newton's iterations of the run", ("law", *kinds), rows)
    page.at_most("iterations over those of J2, median", median(ratios), _MORE)
    if page.short:
        return
    orders = [row.newton.order for row in page.balances if row.newton.order is not None]
    page.at_most("2 minus the order of Newton's method, median over the runs", max(0.0, 2.0 - median(orders)), 0.2)
    drift = max(row.drift for row in page.balances)
    page.at_most("work and energies: largest drift of a run", drift, 0.02)


CASE = Case(
    name="material-elements",
    title="Each law in each kind of element",
    problem="""
A strip of 8 x 4 x 1 mm, clamped at one end; the other end moves up by 1 mm and then out by 0.3 mm; rolling direction at
30 degrees. Laws: each yield function with Swift hardening, each hardening with von Mises, Yld2004 with Chaboche, Hill48
with Yoshida-Uemori and a falling modulus. 14 increments, default points and orders.
""",
    reference="""
J2 in the same run. The order of Newton's method of the whole run, return map and element, is two only if both tangents
are exact.
""",
    own="J2 is umform's own",
    run=run,
    cost=30.0,
)
