"""The library of sheet metals: numbers of the sources, curves that give them back, names, and certificates."""

from __future__ import annotations

import dataclasses
import re
import runpy
from pathlib import Path

import numpy as np
import pytest

import umform as uf
from umform.errors import FileProblem, InvalidValue, UmformError
from umform.materials import Table
from umform.results.forming.limits import KeelerBrazier
from umform.sheet_metals import (
    get,
    names,
    read_flow_curve,
    swift_from_tensile_test,
    tensile_test,
    voce_from_tensile_test,
)

ROOT = Path(__file__).parents[3]

#: R, Rm and total strain at the largest force, in MPa, typed from the sources and rules in docs/materials.md.
SOURCES = {
    "DC04": ((140 + 210) / 2, (270 + 350) / 2, np.exp(0.18) - 1),
    "S235": (235, 360, 0.6 * (1 - 235 / 360)),
    "S355": (355, 510, 0.6 * (1 - 355 / 510)),
    "1.4301": (230, 540, 1 - 230 / 540),
    "EN AW-5754": (80, 190, 0.30 - 0.22 * 80 / 400),
    "DP600": (330, 590, np.exp(0.14) - 1),
}


def test_all_metals_have_a_source_here():
    assert set(names()) == set(SOURCES)


@pytest.mark.parametrize("name", SOURCES)
def test_the_law_gives_back_what_the_source_says(name):
    """By the force of a bar on a fine grid of strains, without any of the formulas that made the curve."""
    metal = get(name)
    R, Rm, total = SOURCES[name]
    assert (metal.yield_stress, metal.tensile_strength) == (R, Rm)
    curve = metal.law.hardening.curve()
    p = np.concatenate([np.linspace(0, 0.004, 2000, endpoint=False), np.linspace(0.004, 0.7, 70001)])
    y = np.array([curve(e)[0] for e in p])
    strain = p + y / metal.young
    nominal, elongation = y * np.exp(-strain), np.expm1(strain)
    assert nominal.max() == pytest.approx(Rm, rel=1e-7)
    assert elongation[nominal.argmax()] == pytest.approx(total, abs=2e-4)
    assert metal.uniform_elongation == pytest.approx(total - Rm / metal.young)
    assert p[nominal.argmax()] == pytest.approx(metal.valid_strain, abs=2e-4)
    plastic = elongation - nominal / metal.young
    assert np.interp(0.002, plastic, nominal) == pytest.approx(R, rel=1e-5)
    assert (np.diff(y) > 0).all()
    assert y[0] > 0.5 * R
    found = tensile_test(metal.law)
    assert found == pytest.approx((R, Rm, metal.uniform_elongation), rel=1e-8)


@pytest.mark.parametrize("name", ["S235", "DP600"])
def test_a_bar_of_elements_has_the_strength_of_the_sheet(name, build):
    metal = get(name)
    model, pull = build.bar(material=metal.law, area=0.2)
    total = metal.uniform_elongation + metal.tensile_strength / metal.young
    result = uf.solve(
        model, [uf.Move(pull, to=total, steps=8), uf.Move(pull, to=1.05 * total, steps=1)], progress=False
    )
    stress = np.abs(result["pull_force"]) / 0.2
    at_top = np.argmin(np.abs(result["pull"] - total))
    assert stress[at_top] == pytest.approx(metal.tensile_strength, rel=1e-6)
    assert stress.max() == stress[at_top]


@pytest.mark.parametrize("name", SOURCES)
def test_a_metal_says_where_it_comes_from(name):
    metal = get(name)
    assert isinstance(metal.law, uf.J2)
    assert (metal.law.E, metal.law.nu) == pytest.approx((metal.young, metal.poisson))
    keys = set(re.findall(r"^@\w+\{(\w+),", (ROOT / "references.bib").read_text(encoding="utf-8"), flags=re.M))
    cited = re.findall(r"\[(\w+)\]", metal.source + metal.derived)
    assert len(cited) >= 2
    assert set(cited) <= keys
    assert metal.basis
    assert metal.caveat
    assert all(text in str(metal) for text in (metal.source, metal.derived, metal.caveat))


@pytest.mark.parametrize("name", SOURCES)
def test_the_page_prints_the_curves_of_the_library(name):
    page = (ROOT / "docs" / "materials.md").read_text(encoding="utf-8")
    row = next(line for line in page.splitlines() if line.startswith(f"| `{name}` |")).split("|")
    metal, printed = get(name), [float(x) for x in re.findall(r"(?<![\w.])\d+\.?\d*", row[-2])]
    curve = metal.law.hardening
    exact = (
        (curve.strength, curve.offset, curve.exponent)
        if isinstance(curve, uf.Swift)
        else (curve.yield_stress, curve.saturation, curve.rate)
    )
    assert printed == pytest.approx(exact, rel=7e-3)
    assert [float(row[4]), float(row[5])] == [metal.yield_stress, metal.tensile_strength]
    assert float(row[7]) == pytest.approx(100 * metal.uniform_elongation, abs=0.051)


@pytest.mark.parametrize(
    ("alias", "name"),
    [
        ("1.0338", "DC04"), ("dc 04", "DC04"), ("1.0038", "S235"), ("S235JR", "S235"), ("s355-j2", "S355"),
        ("AISI 304", "1.4301"), ("aisi304", "1.4301"), ("AlMg3", "EN AW-5754"), ("EN AW 5754 H111", "EN AW-5754"),
        ("HCT590X", "DP600"), ("DP 600", "DP600"),
    ],
)  # fmt: skip
def test_other_names(alias, name):
    assert get(alias) is get(name)


@pytest.mark.parametrize(
    ("wrong", "meant"), [("DC4", "DC04"), ("S236", "S235"), ("AISI 340", "1.4301"), ("HCT580X", "DP600")]
)
def test_an_unknown_name_is_answered_with_the_nearest_one(wrong, meant):
    with pytest.raises(InvalidValue) as caught:
        get(wrong)
    assert caught.value.cause == f"perhaps {meant} is meant"
    assert all(name in caught.value.remedy for name in names())


def test_a_name_far_from_all():
    with pytest.raises(InvalidValue) as caught:
        get("gold")
    assert caught.value.cause == ""


# Certificates -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("K", "e0", "n"), [(520.0, 0.004, 0.22), (1300.0, 0.03, 0.45), (800.0, 0.02, 0.12)])
@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_a_swift_curve_comes_back_from_its_tensile_test(K, e0, n, unit):
    test = tensile_test(uf.J2(E=210e3 * unit, nu=0.3, hardening=uf.Swift(K * unit, e0, n)))
    made = swift_from_tensile_test(*test, young=210e3 * unit)
    assert (made.strength / unit, made.offset, made.exponent) == pytest.approx((K, e0, n), rel=1e-6)


@pytest.mark.parametrize(("name", "most"), [("DC04", 0.055), ("S235", 0.055), ("S355", 0.055), ("DP600", 0.055),
                                            ("1.4301", 0.095), ("EN AW-5754", 0.095)])  # fmt: skip
def test_how_much_the_uniform_elongation_matters(name, most):
    """What docs/materials.md says of the least certain number."""
    metal = get(name)
    swift = isinstance(metal.law.hardening, uf.Swift)
    strains = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
    changes = []
    for factor in (1.2,) if name == "DC04" else (0.8, 1.2):
        other = (swift_from_tensile_test if swift else voce_from_tensile_test)(
            metal.yield_stress, metal.tensile_strength, factor * metal.uniform_elongation, metal.young
        )
        changes += [other.curve()(p)[0] / metal.law.hardening.curve()(p)[0] - 1 for p in strains]
    assert 0.5 * most < np.abs(changes).max() < most


def test_a_voce_curve_comes_back_from_its_tensile_test():
    test = tensile_test(uf.J2(E=70e3, nu=0.3, hardening=uf.Voce(110.0, 290.0, 11.0)))
    made = voce_from_tensile_test(*test, young=70e3)
    assert (made.yield_stress, made.saturation, made.rate) == pytest.approx((110.0, 290.0, 11.0), rel=1e-6)


def test_what_no_curve_can_do_is_refused():
    with pytest.raises(InvalidValue, match="no Swift") as caught:  # a dual-phase steel
        swift_from_tensile_test(330, 590, 0.147, 210e3)
    assert "Voce" in caught.value.remedy
    with pytest.raises(InvalidValue, match="no Swift") as caught:  # a long Lüders strain
        swift_from_tensile_test(355, 360, 0.2, 210e3)
    assert "too high" in caught.value.cause
    with pytest.raises(InvalidValue, match="no Voce"):
        voce_from_tensile_test(355, 360, 0.2, 210e3)


@pytest.mark.parametrize(
    "wrong", [(0, 360, 0.2, 210e3), (360, 235, 0.2, 210e3), (235, 360, 0.2, 210.0), (235, np.nan, 0.2, 210e3)]
)
def test_impossible_certificates_are_refused(wrong):
    for make in (swift_from_tensile_test, voce_from_tensile_test):
        with pytest.raises(InvalidValue, match="a tensile test has"):
            make(*wrong)


def test_per_cent_are_recognised():
    with pytest.raises(InvalidValue) as caught:
        swift_from_tensile_test(235, 360, 20.6, 210e3)
    assert caught.value.remedy == "0.206 for 20.6 %"


def test_a_force_without_maximum_is_refused():
    p = np.linspace(0, 3.5, 36)
    with pytest.raises(InvalidValue, match="no maximum"):
        tensile_test(uf.J2(E=210e3, nu=0.3, hardening=uf.Table(tuple(p), tuple(100 * np.exp(1.5 * p)))))


def test_a_yield_point_elongation_is_not_the_largest_force():
    """Constant yield stress up to a strain of 0.02, over which the force falls before it rises."""
    curve = uf.Table((0.0, 0.02, 0.1, 0.3), (300.0, 300.0, 400.0, 450.0))
    test = tensile_test(uf.J2(E=206e3, nu=0.3, hardening=curve))
    at = 0.1 + 400.0 / 206e3
    strength = 400.0 * np.exp(-at)
    assert test == pytest.approx((299.0, strength, np.expm1(at) - strength / 206e3), rel=3e-4)
    assert uf.sheet_metals.tension_test(uf.Metal(206e3, 0.3, hardening=curve)) == pytest.approx(test, rel=1e-2)
    assert KeelerBrazier.of(1.0, uf.J2(E=206e3, nu=0.3, hardening=curve)).n == pytest.approx(0.1)


@pytest.mark.parametrize(("E", "stress"), [(70e3, 10.0), (1000.0, 60.0)], ids=["soft", "polymer"])
def test_metals_that_do_not_harden_have_their_largest_force_at_yield(E, stress):
    for law in (uf.J2(E, 0.3, hardening=uf.Perfect(stress)), uf.Metal(E, 0.3, hardening=uf.Perfect(stress))):
        test = uf.sheet_metals.tension_test(law)
        assert test.tensile_strength == pytest.approx(stress * np.exp(-stress / E), rel=5e-4)
        assert test.yield_stress <= test.tensile_strength


def test_a_metal_with_a_rate_is_pulled_slowly():
    metal = uf.Metal(206e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2))
    quick = dataclasses.replace(metal, rate=uf.CowperSymonds(40.0, 5.0))
    assert uf.sheet_metals.tension_test(quick) == uf.sheet_metals.tension_test(metal)


@pytest.mark.skipif(not (ROOT / "examples").is_dir(), reason="the examples are not here")
def test_the_picture_of_the_flow_curves():
    figure = runpy.run_path(str(ROOT / "examples" / "flow_curves.py"))["draw"]()
    flow, nominal = figure.axes
    assert [text.get_text() for text in flow.get_legend().get_texts()] == list(names())
    assert len(nominal.lines) == 2 * len(names())


def test_a_flow_curve_is_read(tmp_path):
    path = tmp_path / "coil.csv"
    path.write_text("strain,stress\n0,186  # proof stress\n\n0.05, 275\n0.5,442\n")
    assert read_flow_curve(path) == Table((0.0, 0.05, 0.5), (186.0, 275.0, 442.0))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("0;186\n0.1;200\n", "line 1"),
        ("0,186\n0,1,200\n", "line 2"),
        ("", r"two points or more(.*\n)*.*coil.csv(.*\n)*.*an empty file"),
        ("0,186\n", "one point only"),
        ("0,186\n0.1,nan\n", "finite"),
        ("0,186\n0.1,150\n", "must rise"),
    ],
)
def test_what_is_no_flow_curve_is_refused(text, said, tmp_path):
    path = tmp_path / "coil.csv"
    path.write_text(text)
    with pytest.raises(UmformError, match=said):
        read_flow_curve(path)


def test_a_flow_curve_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(FileProblem, match="cannot be read"):
        read_flow_curve(tmp_path / "no.csv")


def test_s355_has_other_least_values_from_3_mm_on():
    """EN 10025-2: Rm at least 510 MPa below 3 mm, 470 MPa from 3 mm on; ReH 355 in both."""
    for thickness, strength in [(None, 510.0), (2.99, 510.0), (3.0, 470.0), (8.0, 470.0)]:
        metal = get("St 52-3", thickness)
        assert (metal.yield_stress, metal.tensile_strength) == (355.0, strength)
        test = uf.sheet_metals.tension_test(metal.law)
        assert test.tensile_strength == pytest.approx(strength, rel=2e-3)
        assert f"Rm {strength:g} MPa" in metal.note
    assert get("DC04", 5.0) is get("DC04")


@pytest.mark.parametrize("thickness", [0.0, -1.0, float("nan"), "2"])
def test_a_thickness_that_is_none_is_refused(thickness):
    with pytest.raises(InvalidValue, match="thickness"):
        get("St 52-3", thickness)
