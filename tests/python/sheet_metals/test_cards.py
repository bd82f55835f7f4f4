"""Published cards: what they say of tension at angles against what was measured and against independent tables."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from umform import sheet_metals
from umform.errors import InvalidValue
from umform.materials import J2, Metal, tension
from umform.sheet_metals import balanced, cards, get, names, tension_test, uniaxial

ROOT = Path(__file__).parents[3]
ANGLES = (0, 15, 30, 45, 60, 75, 90)
#: Yield stress and r at these angles, then biaxial: from the published coefficients by an independent program.
COMPUTED = {
    "AA2090-T3": (
        (1.00068, 0.95405, 0.90447, 0.81763, 0.82011, 0.89149, 0.90640, 1.02738),
        (0.24506, 0.27035, 0.74288, 1.54452, 1.06516, 0.55735, 0.68495, 0.67466),
    ),
    "AA6016-T4": (
        (0.99870, 0.95177, 0.90262, 0.89728, 0.89929, 0.93956, 0.96792, 0.95738),
        (0.52349, 0.35496, 0.30088, 0.24156, 0.31035, 0.38232, 0.60017, 1.10253),
    ),
}
#: Largest differences to what was measured: of stresses, and of r-values, relative to no less than 0.2.
MEASURED = {
    "AA6016-T4": (0.02, 0.06),
    "AA6016-T4 Postech": (0.02, 0.17),
    "AA2090-T3": (0.02, 0.18),
    "AA6022-T4": (0.01, 0.05),
    "NUMISHEET93 mild steel": (0.0, 1e-9),
}


@pytest.mark.parametrize("name", COMPUTED)
def test_yield_functions_are_those_that_were_published(name):
    law = get(name).law
    stresses, r = COMPUTED[name]
    found = [uniaxial(law.yield_function, angle) for angle in ANGLES] + [balanced(law.yield_function)]
    assert [stress for stress, _ in found] == pytest.approx(stresses, abs=1e-5)
    assert [ratio for _, ratio in found] == pytest.approx(r, abs=1e-5)


@pytest.mark.parametrize("name", MEASURED)
def test_cards_meet_what_was_measured(name):
    card = get(name)
    most_stress, most_r = MEASURED[name]
    for angle, stress in card.measured.stress.items():
        assert uniaxial(card.law.yield_function, angle)[0] == pytest.approx(stress, rel=most_stress)
    for angle, r in card.measured.r.items():
        assert abs(uniaxial(card.law.yield_function, angle)[1] - r) <= most_r * max(r, 0.2)


def test_hill48_of_aluminium_misses_stresses_as_its_caveat_says():
    card = get("AA6016-T4 Hill48")
    assert uniaxial(card.law.yield_function, 45)[0] / card.measured.stress[45] == pytest.approx(1.26, abs=0.005)
    assert uniaxial(card.law.yield_function, 90)[0] / card.measured.stress[90] == pytest.approx(1.06, abs=0.005)
    assert balanced(card.law.yield_function)[0] / card.measured.biaxial == pytest.approx(0.93, abs=0.005)


@pytest.mark.parametrize("name", cards())
def test_numbers_of_tension_are_those_of_a_bar(name):
    """R, Rm and Ag by a path of other strains; the law is a metal with a source in references.bib."""
    card = get(name)
    assert isinstance(card.law, Metal)
    strain, stress, _ = tension(card.law, np.linspace(0.0005, 0.4, 800))
    nominal = stress * np.exp(-strain)
    plastic = np.expm1(strain) - nominal / card.young
    assert nominal.max() == pytest.approx(card.tensile_strength, rel=3e-3)
    assert plastic[nominal.argmax()] == pytest.approx(card.uniform_elongation, abs=0.01)
    assert np.interp(0.002, plastic, nominal) == pytest.approx(card.yield_stress, rel=0.02)
    keys = set(re.findall(r"^@\w+\{(\w+),", (ROOT / "references.bib").read_text(), flags=re.M))
    cited = re.findall(r"\[(\w+)\]", card.source)
    assert cited
    assert set(cited) <= keys


def test_a_bar_at_an_angle():
    """Considere: with the stress s over that of the curve, the largest force is at e0 + s e = n s."""
    law = get("AA2090-T3").law
    K, e0, n = law.hardening.strength, law.hardening.offset, law.hardening.exponent
    for angle in (0, 45):
        s, _ = uniaxial(law.yield_function, angle)
        stress = s * K * (n * s) ** n
        largest = stress * math.exp(e0 / s - n - stress / law.E)
        assert tension_test(law, angle).tensile_strength == pytest.approx(largest, rel=1e-3)
    assert tension_test(get("DC04").law).yield_stress == pytest.approx(175.0)


def test_names_and_aliases():
    assert get("aa6016 t4") is get("AA6016-T4")
    assert not set(names()) & set(cards())
    assert all(isinstance(get(name).law, J2) for name in names())
    assert "Yld2004" in str(get("SPCD"))
    with pytest.raises(InvalidValue, match="SPCC"):
        sheet_metals.get("SPC")


@pytest.mark.parametrize("name", cards())
def test_no_increment_up_to_ten_per_cent_fails(name):
    """12 000 random ones on a path, from 0.01 to 10 % in all directions; a point without an answer raises."""
    law, rng, count = get(name).law.law(), np.random.default_rng(1), 4000
    E, state = np.zeros((count, 6)), np.tile(law.initial(), (count, 1))
    sizes = np.exp(rng.uniform(math.log(1e-4), math.log(0.1), size=(3, count, 1)))
    sizes[-1] = 0.1
    for size in sizes:
        direction = rng.normal(size=(count, 6))
        E = E + size * direction / np.linalg.norm(direction, axis=1, keepdims=True)
        S, CC, state = law.respond(E, state)
        assert all(np.isfinite(values).all() for values in (S, CC, state))
