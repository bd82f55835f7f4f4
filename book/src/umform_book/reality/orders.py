"""Signs and orders on which measurements of springback agree, in a U-bend."""

from __future__ import annotations

from typing import Any

from umform.materials import Metal
from umform.materials.j2 import Plastic
from umform.processes.draw import UBend, draw
from umform.processes.draw.u_bend import NUMISHEET
from umform.results.forming import UBendAngles
from umform.sheet_metals import get
from umform.studies.derivatives.derive import derivatives
from umform_book.case import Case
from umform_book.metals import HARDENING
from umform_book.page import Page
from umform_book.reality.u_bend import isotropic

#: Plastic strain of the sheet before it is drawn.
BEFORE = 0.08
#: Holder forces in N: that of the benchmark, and multiples.
HOLDERS = (2450.0, 9800.0, 24500.0)
#: Standard deviations as they are usual for coils and presses, relative.
SCATTER = {
    "material.hardening.strength": 0.05,
    "friction": 0.2,
    "thickness": 0.02,
    "material.hardening.exponent": 0.05,
    "holder_force": 0.05,
    "material.E": 0.02,
    "die_edge": 0.02,
    "punch_edge": 0.02,
}
#: Numbers of the part, and their names in tables.
_SHAPE = {
    "theta1": "theta1, degrees",
    "radius of the wall": "radius of the wall, mm",
    "draw-in, mean": "draw-in, mm",
}
STEEL: Metal = get("NUMISHEET93 mild steel").law  # type: ignore[assignment]


def case_of(material: Plastic, **changes: Any) -> UBend:
    """The U-bend of NUMISHEET 93 on the coarse mesh."""
    return UBend(**{**NUMISHEET, **UBend.meshes["coarse"], "material": material, **changes})


def angles(**changes: Any) -> UBendAngles:
    """Angles after the release."""
    found = draw(case_of(**changes), progress=False).angles
    assert found is not None
    return found


def run(page: Page) -> None:
    """Fill the page."""
    if page.short:
        curled = angles(material=STEEL)
        page.check("sign of theta1 - 90 degrees", 1.0 if curled.theta1 > 90.0 else -1.0, 1.0, 0.0)
        return
    law = HARDENING["isotropic"]
    runs: dict[str, dict[str, Any]] = {
        **{name: {"material": metal} for name, metal in HARDENING.items()},
        "pre-strained": {"material": isotropic(law, after=BEFORE)},
        **{f"holder {force / 1e3:g} kN": {"material": law, "holder_force": force} for force in HOLDERS[1:]},
    }
    found = {name: angles(**runs[name]) for name in page.each(list(runs))}
    rows = [(name, one.theta1, one.theta2, 1e3 / one.radius) for name, one in found.items()]
    page.table(
        "Steel SPCC in the U-bend", ("", "theta1, degrees", "theta2, degrees", "curvature of the wall, 1/m"), rows
    )
    theta = {name: one.theta1 - 90.0 for name, one in found.items()}
    page.at_most(
        "8 % pre-strain: theta1 - 90 without it, over that with it", theta["isotropic"] / theta["pre-strained"], 1.0
    )
    forces = ["isotropic", *(f"holder {force / 1e3:g} kN" for force in HOLDERS[1:])]
    curl = [1.0 / found[name].radius for name in forces]
    page.at_most(
        "curl of the wall under the largest holder force over that under the smallest", curl[-1] / curl[0], 1.0
    )
    _modulus(page, theta)
    _ranks(page)


def _modulus(page: Page, theta: dict[str, float]) -> None:
    """The falling modulus beside the kind of hardening."""
    constant = theta["Yoshida-Uemori"]
    modulus = theta["Yoshida-Uemori, falling modulus"] - constant
    kinds = [theta[name] for name in ("isotropic", "Chaboche", "Yoshida-Uemori")]
    page.at_most(
        "range of theta1 over the kinds of hardening, over the change by a falling modulus",
        (max(kinds) - min(kinds)) / modulus,
        2.0,
    )
    page.text(
        f"A modulus that falls from 206 to 152 GPa adds {modulus:.1f} degrees to theta1; the three kinds of hardening "
        f"differ by {max(kinds) - min(kinds):.1f} degrees."
    )


def _ranks(page: Page) -> None:
    """What makes the shape scatter."""
    case = case_of(STEEL, turn=12.0).steady()
    found = derivatives(case, list(SCATTER), list(_SHAPE), progress=False)

    def scatter(what: str, path: str) -> float:
        derivative = found[what, path]
        assert derivative.value is not None
        return float(derivative.value * derivative.parameter.value * SCATTER[path])

    rows: list[tuple[str | float, ...]] = [
        (path, 100.0 * size, *(scatter(what, path) for what in _SHAPE)) for path, size in SCATTER.items()
    ]
    page.table("Changes by one standard deviation", ("parameter", "standard deviation, %", *_SHAPE.values()), rows)
    by_size = sorted(SCATTER, key=lambda path: -abs(scatter("theta1", path)))
    page.check("rank of the strength in theta1", by_size.index("material.hardening.strength") + 1, 1.0, 0.0)
    first = max(SCATTER, key=lambda path: abs(scatter("draw-in, mean", path)))
    page.check("friction is first in the draw-in", float(first == "friction"), 1.0, 0.0)
    page.text(
        f"The strength of the sheet is first in theta1. Friction is {by_size.index('friction') + 1}th there, at the "
        f"holder force of {HOLDERS[0] / 1e3:g} kN, and not beside the strength as in the reference; it is first in the "
        "draw-in."
    )


CASE = Case(
    name="reality-orders",
    title="Signs and orders of springback",
    problem=f"""
The U-bend of NUMISHEET 93 as `umform draw u --coarse` computes it, with the steel SPCC of
[each kind of hardening](material-u-bend.md): without pre-strain; after a plastic strain of {BEFORE:g} with the same
thickness (isotropic hardening); with holder forces of {", ".join(f"{force / 1e3:g}" for force in HOLDERS)} kN. Then
derivatives by eight parameters, times usual standard deviations, with the mild steel of the benchmark, equal
increments and elements that turn by 12 degrees.
""",
    reference="""
Signs on which published measurements agree; their numbers are for other sheets and are not compared. Pre-strain of
8 % raises springback (DP780, NUMISHEET 2011, benchmark 4). A wall under more tension curls less: springback of the
draw-bend test falls with the back force (Carden, Geng, Matlock and Wagoner, Int. J. Mech. Sci. 44 (2002) 79). A
modulus that falls with plastic strain matters as much as the kind of hardening (Yoshida, Uemori and Fujiwara, Int. J.
Plasticity 18 (2002) 633). The yield stress of the coil is first in the scatter of springback, beside friction (de
Souza and Rolfe, J. Mater. Process. Technol. 203 (2008) 129).
""",
    own="the numbers; signs and orders are from measurements",
    run=run,
    cost=180.0,
)
