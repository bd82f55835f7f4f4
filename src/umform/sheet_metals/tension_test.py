"""Proof stress, tensile strength and uniform elongation of any metal, from tension of a material point."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from umform.errors import InvalidValue
from umform.materials import J2, Metal, tension
from umform.sheet_metals.tensile_test import OFFSET, TensileTest, tensile_test

#: Logarithmic strains of the test: fine at yield, coarse up to the largest force.
_STRAINS = np.concatenate([np.linspace(2.5e-4, 0.02, 80), np.arange(0.022, 0.3, 0.002), np.geomspace(0.3, 1.2, 40)])


def tension_test(law: J2 | Metal, angle: float = 0.0) -> TensileTest:
    """Rp0.2, Rm and Ag of a bar at an angle to the rolling direction, pulled slowly: without the factor of a rate.

    Parameters
    ----------
    law : J2 or Metal
        The metal.
    angle : float
        Degrees from the rolling direction to the bar.

    Returns
    -------
    TensileTest
        Stresses are forces over the first area; interpolated between the strains of a path, to about 2e-3.

    Raises
    ------
    InvalidValue
        If the force has no maximum up to a logarithmic strain of 1.2.
    """
    if isinstance(law, J2):
        return tensile_test(law)
    strain, stress, strain_left = tension(replace(law, rate=None), _STRAINS, angle)
    nominal, elongation = stress * np.exp(-strain), np.expm1(strain)
    plastic = elongation - nominal / law.E
    top = int(np.argmax(nominal))
    if top == len(nominal) - 1:
        raise InvalidValue(
            "the force of a tensile test has no maximum",
            where="tension_test",
            value=law,
            cause="the law hardens for ever, or not at all",
            remedy="a law with saturation or a power, such as Swift or Voce",
        )
    proof = OFFSET if plastic[top] > OFFSET else plastic[top]
    strength, at = float(nominal[top]), float(strain[top])
    if top > 0 and strain_left[top - 1, 0] > 0.0:  # otherwise the force falls from yield on
        parabola = np.polynomial.Polynomial.fit(strain[top - 1 : top + 2], nominal[top - 1 : top + 2], 2)
        at = float(parabola.deriv().roots()[0].real)
        strength = float(parabola(at))
    return TensileTest(float(np.interp(proof, plastic, nominal)), strength, math.expm1(at) - strength / law.E)
