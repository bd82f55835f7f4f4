"""Flow curves from certificate data of a tensile test, and vice versa.

A bar under uniaxial tension is, in the law J2, in a state of Kirchhoff stress y(p) and logarithmic strain p + y/E, with
p the plastic strain. The force over the first area, against the stretch L, is therefore

    s = y(p) / L,    L = exp(p + y/E).

The proof stress Rp0.2 is s where L - 1 - s/E = 0.002. The tensile strength Rm is the largest s: there ds = 0, which is
the condition of Considère, y' = y / (1 - y/E), and the uniform elongation Ag is L - 1 - Rm/E. Three numbers of a
certificate are three equations for the three constants of a curve. The steps are in docs/materials.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from umform.errors import InvalidValue
from umform.materials import J2, Hardening, LinearVoce, Swift, Table, Voce

#: Plastic elongation at the proof stress Rp0.2.
OFFSET = 0.002

#: Range of plastic strain in which the largest force is sought.
_LARGEST = 3.0
#: Number of strains at which it is sought first: a table may have several maxima.
_SOUGHT_AT = 601


class TensileTest(NamedTuple):
    """Results of a tensile test.

    Attributes
    ----------
    yield_stress : float
        Rp0.2, force over the first area.
    tensile_strength : float
        Rm, force over the first area.
    uniform_elongation : float
        Ag, plastic elongation at the largest force, as a fraction of the length (not in per cent).
    """

    yield_stress: float
    tensile_strength: float
    uniform_elongation: float


class _Anchors(NamedTuple):
    """Points of a flow curve: plastic strain and Kirchhoff stress at yield and at the largest force."""

    p_yield: float
    y_yield: float
    p_top: float
    y_top: float
    slope_top: float


def swift_from_tensile_test(
    yield_stress: float, tensile_strength: float, uniform_elongation: float, young: float
) -> Swift:
    """Swift curve y = K (e0 + p)^n through Rp0.2 that has its largest force at Rm and Ag.

    With the plastic strain p_m, the Kirchhoff stress y_m and the slope y_m / (1 - y_m/E) at the largest force,

        n = (e0 + p_m) / (1 - y_m/E),    K = y_m / (e0 + p_m)^n,

    and e0 follows from y(p at Rp0.2). There is no such e0 > 0 if the curve bends more than a power of the strain can,
    as those of dual-phase steels often do: take :func:`voce_from_tensile_test` then.

    Parameters
    ----------
    yield_stress, tensile_strength : float
        Rp0.2 (or the lower yield stress) and Rm, in the unit of `young`.
    uniform_elongation : float
        Ag as a fraction: 0.2 for 20 %.
    young : float
        Young's modulus.

    Returns
    -------
    Swift
        The curve; stresses in the unit of `young`.

    Raises
    ------
    InvalidValue
        If no Swift curve has these three properties.

    Examples
    --------
    >>> curve = swift_from_tensile_test(235, 360, 0.206, 210e3)
    >>> round(curve.exponent, 3)
    0.193
    """
    at = _anchors(yield_stress, tensile_strength, uniform_elongation, young)
    stiff = 1.0 - at.y_top / young

    def excess(offset: float) -> float:
        ratio = math.log((offset + at.p_yield) / (offset + at.p_top))
        return at.y_top * math.exp(ratio * (offset + at.p_top) / stiff) - at.y_yield

    least, most = 1e-12, stiff - at.p_top  # n <= 1
    if excess(least) > 0:
        raise _no_curve("Swift", at, "the yield stress is too low for the uniform elongation", "take Voce")
    if excess(most) < 0:
        raise _no_curve(
            "Swift",
            at,
            "the yield stress is too high for the uniform elongation",
            "give a table: a long Lüders strain needs one",
        )
    offset = _root(excess, least, most)
    exponent = (offset + at.p_top) / stiff
    return Swift(at.y_top / (offset + at.p_top) ** exponent, offset, exponent)


def voce_from_tensile_test(
    yield_stress: float, tensile_strength: float, uniform_elongation: float, young: float
) -> LinearVoce:
    """Voce curve y = y_inf - (y_inf - y0) exp(-d p) through Rp0.2 that has its largest force at Rm and Ag.

    With the slope h = y_m / (1 - y_m/E) at the largest force, (y_inf - y0) exp(-d p_m) = h/d, y_inf = y_m + h/d, and d
    follows from y(p at Rp0.2).

    Parameters and errors are those of :func:`swift_from_tensile_test`.

    Returns
    -------
    LinearVoce
        Without the linear part.
    """
    at = _anchors(yield_stress, tensile_strength, uniform_elongation, young)
    span = at.p_top - at.p_yield

    def excess(rate: float) -> float:
        return at.y_top - at.slope_top * math.expm1(rate * span) / rate - at.y_yield

    if at.y_top - at.slope_top * span <= at.y_yield:
        raise _no_curve(
            "Voce", at, "the yield stress is too high for the uniform elongation", "give a table, or linear hardening"
        )
    most = 1.0 / span
    while excess(most) > 0:
        most *= 2.0
    rate = _root(excess, 1e-6 / span, most)
    drop = at.slope_top / rate
    saturation = at.y_top + drop
    return Voce(saturation - drop * math.exp(rate * at.p_top), saturation, rate)


def necking_strain(hardening: Hardening, young: float = math.inf) -> float:
    """Plastic strain at the largest force y / L, by Considère; 3 if it still rises there.

    Parameters
    ----------
    hardening : Hardening
        The curve.
    young : float
        Young's modulus; infinite without elastic strains.
    """
    curve = hardening.curve()

    def considere(p: float) -> float:
        y, slope = curve(p)
        return slope * (1.0 - y / young) - y

    bends = [p for p in hardening.eqps if p < _LARGEST] if isinstance(hardening, Table) else []
    strains = np.union1d(np.linspace(0.0, _LARGEST, _SOUGHT_AT), bends)
    stresses = np.array([curve(p)[0] for p in strains.tolist()])
    most = int(np.argmax(np.log(stresses) - strains - stresses / young))
    if most == len(strains) - 1:
        return _LARGEST
    least, last = float(strains[max(most - 1, 0)]), float(strains[most + 1])
    beside = math.nextafter(least, math.inf)  # in a bend the slope is that of one side
    return least if considere(beside) <= 0.0 else _root(considere, beside, math.nextafter(last, 0.0))


def tensile_test(law: J2) -> TensileTest:
    """Rp0.2, Rm and Ag of a law.

    Raises
    ------
    InvalidValue
        If the force has no maximum up to a plastic strain of 3.
    """
    curve = law.hardening.curve()

    def nominal(p: float) -> tuple[float, float]:
        y = curve(p)[0]
        strain = p + y / law.E
        return y * math.exp(-strain), math.expm1(strain)

    top = necking_strain(law.hardening, law.E)
    if top == _LARGEST:
        raise InvalidValue(
            "the force of a tensile test has no maximum",
            where="tensile_test",
            value=law.hardening,
            cause="the law hardens for ever, or not at all",
            remedy="a law with saturation or a power, such as Swift or Voce",
        )
    strength, elongation = nominal(top)
    return TensileTest(_proof_stress(nominal, law.E), strength, elongation - strength / law.E)


def _proof_stress(nominal: Callable[[float], tuple[float, float]], young: float) -> float:
    """Rp0.2 from stress and elongation at plastic strains; with large elastic strains a bar has it before it yields."""

    def offset(stress: float, elongation: float) -> float:
        return elongation - stress / young - OFFSET

    def elastic(strain: float) -> tuple[float, float]:
        return young * strain * math.exp(-strain), math.expm1(strain)

    if offset(*nominal(0.0)) < 0.0:
        return nominal(_root(lambda p: offset(*nominal(p)), 0.0, 0.01))[0]
    return elastic(_root(lambda strain: offset(*elastic(strain)), 0.0, math.log1p(nominal(0.0)[1])))[0]


def _root(of: Callable[[float], float], least: float, most: float) -> float:
    """Zero of a function that changes its sign between two numbers, to the last bit, by bisection."""
    first, last = of(least), of(most)
    if first * last > 0.0:
        raise ValueError("the function has the same sign at both ends")
    if first == 0.0:
        return least
    positive = first > 0.0
    while least < (middle := 0.5 * (least + most)) < most:
        if (of(middle) > 0.0) == positive:
            least = middle
        else:
            most = middle
    return middle


def _anchors(yield_stress: float, tensile_strength: float, uniform_elongation: float, young: float) -> _Anchors:
    """Points of the flow curve that belong to a certificate."""
    given = (yield_stress, tensile_strength, uniform_elongation, young)
    if not all(math.isfinite(x) and x > 0 for x in given) or not yield_stress < tensile_strength < 0.1 * young:
        raise InvalidValue(
            "a tensile test has 0 < Rp0.2 < Rm, far below Young's modulus, and a positive uniform elongation",
            where="tensile test",
            value=f"Rp0.2 = {yield_stress}, Rm = {tensile_strength}, Ag = {uniform_elongation}, E = {young}",
            cause="stresses and modulus in different units, or two numbers exchanged",
            remedy="numbers in MPa, the elongation as a fraction: 160, 300, 0.22",
        )
    if not OFFSET < uniform_elongation <= 1.0:
        raise InvalidValue(
            "the uniform elongation is a fraction between 0.002 and 1",
            where="uniform elongation",
            value=uniform_elongation,
            cause="it is given in per cent",
            remedy=f"{uniform_elongation / 100:g} for {uniform_elongation:g} %",
        )
    points = []
    for stress, plastic in ((yield_stress, OFFSET), (tensile_strength, uniform_elongation)):
        stretch = 1.0 + plastic + stress / young
        points += [math.log(stretch) - stress * stretch / young, stress * stretch]
    p_yield, y_yield, p_top, y_top = points
    return _Anchors(p_yield, y_yield, p_top, y_top, y_top / (1.0 - y_top / young))


def _no_curve(name: str, at: _Anchors, cause: str, remedy: str) -> InvalidValue:
    return InvalidValue(
        f"no {name} curve goes through these values",
        value=f"y = {at.y_yield:.4g} at {at.p_yield:.4g}, y = {at.y_top:.4g} at {at.p_top:.4g}",
        cause=cause,
        remedy=remedy,
    )
