"""Bends under a given tension: stretch, thinning, moment and springback of one element against fibres."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform_book.case import Case
from umform_book.metals import HARDENING
from umform_book.page import Page
from umform_book.plastic.pulled_section import FIBRES, ElementSection, FibreSection

Floats = NDArray[np.float64]

LAWS = ("isotropic", "Chaboche", "Yoshida-Uemori, falling modulus")
RADII, TENSIONS = (5.0, 10.0, 20.0, 50.0, 100.0), (0.3, 0.6)
YIELD_FORCE = 2.0 / np.sqrt(3.0) * 141.6
#: Limits of stretch and thinning, of the moment, of the springback.
WITHIN, MOMENT, SPRINGBACK = 0.03, 0.015, 0.01
_GRADED: dict[str, Any] = {"thickness_points": 18, "thickness_rule": "graded"}
ELEMENTS: dict[str, tuple[str, dict[str, Any]]] = {
    "ANS3DEAS": ("ANS3DEAS", {}),
    "ANS3DEAS, plane strain": ("ANS3DEAS", {"plane_strain": True}),
    "BEND18": ("BEND18", {}),
    "ANS3DEAS, 18 graded": ("ANS3DEAS", _GRADED),
}
STATES = ("bent", "straight again", "bent again")
WHAT = ("stretch", "thinning", "moment", "springback")


def path(section: FibreSection | ElementSection, radius: float, tension: float, increments: int) -> Floats:
    """Stretch of the middle fibre, thinning, moment and springback, of each of the three states: (3, 4)."""
    rows = []
    section.bend(0.0, tension, 8)
    for curvature in (1.0 / radius, 0.0, 1.0 / radius):
        section.bend(curvature, tension, increments)
        springback = curvature - section.released()
        rows.append((section.stretch - 1.0, 1.0 - section.thickness, section.moment, springback))
    return np.array(rows)


def run(page: Page) -> None:
    """Fill the page."""
    cases = [(law, R, T) for law in LAWS for R in RADII for T in TENSIONS]
    names = page.pick(tuple(ELEMENTS), ("ANS3DEAS", "ANS3DEAS, 18 graded"))
    fibres, increments = page.pick((FIBRES, 40), (400, 20))
    exact: dict[tuple[str, float, float], Floats] = {}
    errors: dict[str, dict[tuple[str, float, float], Floats]] = {name: {} for name in names}
    for case in page.each(
        page.pick(cases, [("isotropic", 10.0, 0.3)]), lambda c: f"{c[0]}, R/h = {c[1]:g}, T = {c[2]:g}"
    ):
        law, R, T = case
        exact[case] = path(FibreSection(HARDENING[law], fibres), R, T * YIELD_FORCE, increments)
        for name in names:
            element, options = ELEMENTS[name]
            found = path(ElementSection(element, HARDENING[law], **options), R, T * YIELD_FORCE, increments)
            errors[name][case] = found / exact[case] - 1.0
    _fibres(page, exact)
    for name in names:
        _deviations(page, name, errors[name])
        if ELEMENTS[name][1] is not _GRADED:
            _judge(page, name, errors[name])
    _wall(page, exact, errors)
    _limits(page, errors)


def _fibres(page: Page, exact: dict[tuple[str, float, float], Floats]) -> None:
    columns = ("law, R/h, T", *(f"{what}, {state}" for state in STATES for what in ("stretch %", "thinning %")))
    rows = [
        (f"{law}, {R:g}, {T:g}", *(100.0 * value for state in found for value in state[:2]))
        for (law, R, T), found in exact.items()
    ]
    page.table("Stretch of the middle fibre and thinning, fibres", columns, rows)


def _deviations(page: Page, name: str, errors: dict[tuple[str, float, float], Floats]) -> None:
    columns = ("law, R/h, T", *(f"{what}, {state}" for state in STATES for what in WHAT))
    rows = [(f"{law}, {R:g}, {T:g}", *(100.0 * found.ravel())) for (law, R, T), found in errors.items()]
    page.table(f"{name}: deviation from the fibres in %", columns, rows)


def _judge(page: Page, name: str, errors: dict[tuple[str, float, float], Floats]) -> None:
    every = np.abs(np.array(list(errors.values())))
    page.at_most(f"{name}: stretch of the middle fibre", every[..., 0].max(), WITHIN)
    page.at_most(f"{name}: thinning of the straightened sheet", every[:, 1, 1].max(), WITHIN)
    page.at_most(f"{name}: moment", every[..., 2].max(), MOMENT)
    page.at_most(f"{name}: springback", every[..., 3].max(), SPRINGBACK)


def _wall(
    page: Page,
    exact: dict[tuple[str, float, float], Floats],
    errors: dict[str, dict[tuple[str, float, float], Floats]],
) -> None:
    page.heading("The wall pulled over a radius")
    page.text(
        "A wall that is drawn over a radius is bent and straightened under its tension: the second state of the "
        "tables above."
    )
    columns = ("law, R/h, T", "thinning %, fibres", *(f"%, {name}" for name in errors))
    rows = [
        (
            f"{law}, {R:g}, {T:g}",
            100.0 * found[1, 1],
            *(100.0 * found[1, 1] * (1.0 + of[law, R, T][1, 1]) for of in errors.values()),
        )
        for (law, R, T), found in exact.items()
        if R <= 20.0
    ]
    page.table("Thinning of the wall after the radius", columns, rows)


def _limits(page: Page, errors: dict[str, dict[tuple[str, float, float], Floats]]) -> None:
    name = "ANS3DEAS"
    bent = 100.0 * np.array([found[[0, 2]] for found in errors[name].values()])
    sharp = [found for (_, R, T), found in errors[name].items() if R <= 10.0 and TENSIONS[-1] == T]
    moments = ""
    if sharp:
        of = 100.0 * np.array(sharp)[..., 2]
        moments = (
            f" At R/h up to 10 and T = {TENSIONS[-1]:g} the moments of {name} differ by {of.min():+.1f} to "
            f"{of.max():+.1f} %."
        )
    page.text(
        "The remaining error comes from the thickness strain of the element, not from the points. In a sharp bend "
        "outer fibres thin, and inner fibres thicken, by a tenth and more. The strain is that of Green and Lagrange, "
        "so the distance of the faces is the root mean square of the stretches of the fibres. At R/h = 5 it exceeds "
        "their mean by 0.15 % of the thickness. While the sheet is bent, the distance of the faces of "
        f"{name} differs from that of the fibres by {bent[..., 1].min():+.1f} to {bent[..., 1].max():+.1f} % of the "
        f"thinning. When the sheet is straight again, the difference vanishes.{moments}"
    )


CASE = Case(
    name="plastic-pulled-bend",
    title="Bends under tension",
    problem=r"""
One element of a wide sheet of thickness 1 is bent to the radius R of its middle fibre, straightened, and bent again.
The tension is constant, T = 0.3 or 0.6 of the yield force $2/\sqrt3 \cdot 141.6$. For the springback, each of the three
states is also released to zero force and moment. The nodes follow the section: middle fibre on an arc, directors
straight; stretch and thickness are free. Steel with isotropic hardening, with Chaboche's back stresses, and with that
of Yoshida and Uemori and a modulus that falls with the plastic strain ([laws](material-bending.md)). Default points
through the thickness, and 18 `graded` points for comparison.
""",
    reference=f"""
{FIBRES} fibres of the same law, which may move against each other, in equilibrium through the thickness. The radial
load that balances the tension acts at the middle fibre.
""",
    run=run,
    cost=300.0,
)
