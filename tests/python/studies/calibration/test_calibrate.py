"""Laws from measurements: constants come back, uncertainty is told, deck and Python make the same law."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter
from typer.testing import CliRunner

import umform as uf
from umform.cli import app
from umform.errors import InvalidValue
from umform.problem.material import MaterialPart
from umform.problem.tagged import deck_type
from umform.sheet_metals import CURVE_FITS, Directions, fit_chaboche, get
from umform.studies.calibration import Calibration, Measurements, calibrate, read_cycles, read_tension
from umform.studies.calibration.code import deck_block, python_code
from umform.studies.calibration.measurements import Test, Unloading
from umform.studies.calibration.pictures import curve_of, over_the_angle, pictures
from umform.studies.calibration.words import remarks

EXAMPLES = Path(__file__).parents[4] / "examples" / "metals"
LAWS = {
    "J2": uf.J2(210e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.22)),
    "Perfect": uf.J2(210e3, 0.3, hardening=uf.Perfect(200.0)),
    "Linear": uf.J2(210e3, 0.3, hardening=uf.Linear(200.0, 1000.0)),
    "Table": uf.J2(210e3, 0.3, hardening=uf.Table((0.0, 0.1), (200.0, 300.0))),
    "Chaboche": uf.Metal(
        210e3,
        0.3,
        hardening=uf.LinearVoce(180.0, 10.0, 240.0, 12.0),
        yield_function=uf.Hill48(1.8, 1.5, 2.2),
        back_stress=uf.Chaboche([(4000.0, 80.0), (600.0, 6.0)], first=0.5, rate=3.0),
        modulus=uf.FallingModulus(160e3, 30.0),
    ),
    "stresses": uf.Metal(
        7e4, 0.33, hardening=uf.Voce(1e2, 2e2, 9.0), yield_function=uf.Hill48.from_stresses(1.0, 0.95, 0.98, 0.96)
    ),
    **{name: get(name).law for name in ("AA2090-T3", "SPCC", "TRIP1180")},
}


@pytest.mark.parametrize("name", LAWS)
def test_deck_and_python_make_the_same_law(name):
    law, names = LAWS[name], {}
    exec(python_code(law), names)
    part = TypeAdapter(deck_type(MaterialPart)).validate_python(tomllib.loads(deck_block(law))["material"])
    assert part.law == names["material"]
    strains = np.linspace(0.001, 0.02, 5)
    if isinstance(law, uf.Metal):
        expected, found = (uf.materials.tension(each, strains)[1] for each in (law, names["material"]))
        assert found == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(
    ("kind", "curve"),
    [
        ("swift", uf.Swift(520.0, 0.004, 0.22)),
        ("voce", uf.Voce(150.0, 300.0, 12.0)),
        ("linear-voce", uf.LinearVoce(150.0, 200.0, 280.0, 15.0)),
        ("linear", uf.Linear(150.0, 800.0)),
        ("perfect", uf.Perfect(150.0)),
    ],
)
def test_each_hardening_curve_comes_back_from_tension(kind, curve):
    eqps = np.geomspace(1e-3, 0.25, 30)
    stress = np.array([curve.curve()(e)[0] for e in eqps])
    tension = Test(eqps + stress / 2e5, stress)
    found = calibrate(Measurements(tension=tension), 2e5, hardening=kind)
    assert found.law == uf.J2(2e5, 0.3, hardening=found.fits["hardening"].law)
    assert found.law.hardening.curve()(0.1)[0] == pytest.approx(curve.curve()(0.1)[0], rel=1e-5)
    assert found.fits["hardening"].undetermined == ()
    assert curve_of(found.law, tension)[1][-1] == pytest.approx(stress[-1], rel=1e-3)


def test_the_best_curve_is_taken():
    tension = read_tension(EXAMPLES / "aa6016_tension.csv", 70e3, engineering=True)
    found = calibrate(Measurements(tension=tension), 70e3)
    assert vars(found.law.hardening) == pytest.approx(
        {"strength": 478.2, "offset": 0.0068, "exponent": 0.2895}, rel=1e-3
    )
    assert found.others["voce"] > 1.0
    assert any("strength and exponent" in text for text in remarks(found))


def test_a_table_rises_and_follows():
    eqps = np.linspace(0.001, 0.2, 200)
    noisy = 500.0 * (0.01 + eqps) ** 0.2 + np.random.default_rng(0).normal(size=200)
    found = CURVE_FITS["table"](eqps, noisy)
    assert (np.diff(found.law.stress) >= 0).all()
    assert found.misfit < 0.6


def test_tension_is_led_back_through_the_yield_function():
    """With stress 0.98 along the rolling direction over the curve, the bar of the law has the measured stress."""
    directions = Directions({0: 1.0, 45: 0.95, 90: 0.98}, {0: 0.6, 45: 0.4, 90: 0.7}, biaxial=0.97)
    tension = read_tension(EXAMPLES / "aa6016_tension.csv", 70e3, engineering=True)
    found = calibrate(Measurements(directions, tension), 70e3)
    assert isinstance(found.law, uf.Metal)
    strain, stress = curve_of(found.law, tension)
    assert np.interp(tension.strain, strain, stress) == pytest.approx(tension.stress, rel=2e-3)
    assert len(over_the_angle(found.yield_function, directions).axes) == 2


def test_constants_of_yoshida_and_uemori_come_back():
    """From an explicit integration with tiny steps: C, m and h as far as steps of 1e-3 allow, the sizes well."""
    cycles = read_cycles(EXAMPLES / "spcc_cycles.csv", 206e3)
    cycles = Test(cycles.strain[:76], cycles.stress[:76])  # once forth and back
    found = calibrate(Measurements(cycles=cycles), 206e3, back_stress="yoshida-uemori", largest_step=2e-3)
    constants = found.fits["cycles"].constants
    assert constants["Y"] == pytest.approx(124.0, rel=0.02)
    assert constants["B - Y"] + constants["Y"] == pytest.approx(168.0, rel=0.02)
    assert constants["growth"] == pytest.approx(190.0, rel=0.03)
    assert constants["m"] == pytest.approx(12.0, rel=0.05)
    assert constants["C"] == pytest.approx(500.0, rel=0.3)
    assert found.fits["cycles"].misfit < 0.5


def test_a_back_stress_comes_back_from_a_half_cycle():
    metal = uf.Metal(2e5, 0.3, hardening=uf.Voce(200.0, 230.0, 10.0), back_stress=uf.Chaboche([(5000.0, 60.0)]))
    strain = np.concatenate([np.linspace(0.002, 0.03, 12), np.linspace(0.028, -0.03, 25)])
    stress = uf.materials.tension(metal, strain)[1]
    found = fit_chaboche([(strain, stress)], 1, 2e5, 0.3, largest_step=5e-3)
    assert found.undetermined == ()
    assert found.constants["C1"] == pytest.approx(5000.0, rel=0.02)
    assert found.constants["gamma1"] == pytest.approx(60.0, rel=0.02)


FALLING = uf.FallingModulus(160e3, 40.0)


def slopes(young=206e3, noise=0.0):
    eqps = np.array([0.002, 0.005, 0.01, 0.02, 0.04, 0.06, 0.1])
    return Unloading(eqps, young * FALLING.share(young, eqps) + noise * np.array([1, -1, 1, -1, 1, -1, 1]))


def test_a_falling_modulus_comes_back_from_slopes_of_unloading():
    found = calibrate(Measurements(unloading=slopes()), 206e3)
    assert found.law is None
    assert vars(found.fits["modulus"].law) == pytest.approx(vars(FALLING), rel=1e-5)
    noisy = calibrate(Measurements(unloading=slopes(noise=1000.0)), 206e3).fits["modulus"]
    assert abs(noisy.constants["saturated"] - 160e3) < 2.0 * noisy.deviations["saturated"] < 5e3
    assert noisy.undetermined == ()


def test_tension_and_cycles_are_fitted_with_the_modulus_that_falls():
    curve = uf.Swift(520.0, 0.004, 0.22)
    metal = uf.Metal(206e3, 0.3, hardening=curve, modulus=FALLING)
    strain = np.geomspace(2e-3, 0.2, 40)
    tension = Test(strain, uf.materials.tension(metal, strain)[1])
    with_slopes = calibrate(Measurements(tension=tension, unloading=slopes()), 206e3, hardening="swift")
    assert with_slopes.law.modulus == with_slopes.fits["modulus"].law
    assert vars(with_slopes.law.hardening) == pytest.approx(vars(curve), rel=2e-3)
    without = calibrate(Measurements(tension=tension), 206e3, hardening="swift")
    assert with_slopes.fits["hardening"].misfit < 0.2 * without.fits["hardening"].misfit
    names: dict[str, object] = {}
    exec(python_code(with_slopes.law), names)
    assert names["material"].modulus.saturated == pytest.approx(160e3, rel=1e-4)
    back = uf.Metal(
        2e5, 0.3, hardening=uf.Voce(200.0, 230.0, 10.0), back_stress=uf.Chaboche([(5000.0, 60.0)]), modulus=FALLING
    )
    path = np.concatenate([np.linspace(0.002, 0.03, 12), np.linspace(0.028, -0.03, 25)])
    cycles = Test(path, uf.materials.tension(back, path)[1])
    data = Measurements(cycles=cycles, unloading=slopes(2e5))
    cycled = calibrate(data, 2e5, back_stress="chaboche1", largest_step=5e-3).fits["cycles"]
    assert cycled.constants["C1"] == pytest.approx(5000.0, rel=0.02)
    assert cycled.misfit < 0.05


def test_slopes_of_unloading_on_the_command_line_with_other_names_of_columns(tmp_path):
    found = slopes()
    rows = "\n".join(f"{100 * p:.12g},{E:.12g}" for p, E in zip(found.eqps, found.modulus, strict=True))
    (tmp_path / "slopes.csv").write_text(f"Dehnung,E chord\n{rows}\n")
    words = ["metal", "fit", "--young", "206000", "--unloading", str(tmp_path / "slopes.csv"), "--percent"]
    missing = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "out")])
    assert missing.exit_code == 1
    assert "the column plastic_strain is missing" in missing.output
    names = ["--column", "plastic_strain=Dehnung", "--column", "modulus=E chord"]
    done = CliRunner().invoke(app, [*words, *names, "--out", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    assert "saturated   160000" in done.output
    assert "modulus = { saturated = 160000.0, rate = 40.0 }" in (tmp_path / "out" / "metal.toml").read_text()
    assert (tmp_path / "out" / "modulus.png").is_file()
    for wrong, said in (("Dehnung=strain", "this renames no column"), ("stress", "the sign = is missing")):
        refused = CliRunner().invoke(app, [*words, "--column", wrong])
        assert said in refused.output
    for name, row, said in (("gpa", "0.02,185", "at most Young's modulus"), ("percent", "5,185000", "per cent")):
        (tmp_path / f"{name}.csv").write_text("plastic_strain,modulus\n" + f"{row}\n" * 3)
        refused = CliRunner().invoke(app, [*words[:5], str(tmp_path / f"{name}.csv")])
        assert said in refused.output, refused.output


def test_what_measurements_do_not_tell_is_named():
    """Without a value at 45 degrees nothing determines r45; a short curve has one slope, not three numbers."""
    found = calibrate(Measurements(Directions({0: 1.0, 90: 1.02}, {0: 1.8, 90: 2.2})), 2e5)
    assert found.fits["yield function"].undetermined == ("r45",)
    assert any("do not determine r45" in text for text in remarks(found))
    assert "not determined: r45" in str(found.fits["yield function"])
    eqps = np.linspace(0.001, 0.004, 8)
    short = CURVE_FITS["linear-voce"](eqps, 200.0 + 1000.0 * eqps + 0.05 * np.cos(1e5 * eqps))
    assert short.undetermined


def test_refusals():
    with pytest.raises(InvalidValue, match="no measurements to fit"):
        calibrate(Measurements(), 2e5)
    with pytest.raises(InvalidValue, match="one of hill48, yld2004"):
        calibrate(Measurements(), 2e5, yield_function="hill")
    with pytest.raises(InvalidValue, match="too few measurements for Yld2004"):
        calibrate(Measurements(Directions({}, {0: 1.0, 45: 1.2, 90: 1.1})), 2e5, yield_function="yld2004")


def test_pictures_show_data_and_fit():
    """Measured points as given, and the fit near them: over the angle, on the yield locus, in tension, in a cycle."""
    law = LAWS["Chaboche"]
    angles = (0.0, 45.0, 90.0)
    measured = Directions(
        {a: float(uf.sheet_metals.uniaxial(law.yield_function, a)[0]) for a in angles},
        {a: float(uf.sheet_metals.uniaxial(law.yield_function, a)[1]) for a in angles},
        biaxial=1.1,
    )
    ways = {"tension": np.linspace(0.01, 0.1, 10), "cycles": np.array([0.01, 0.02, 0.01, -0.01])}
    tests = {name: Test(strain, uf.materials.tension(law, strain)[1]) for name, strain in ways.items()}
    drawn = dict(pictures(Calibration(Measurements(measured, **tests), law, law.yield_function, {})))
    assert set(drawn) == {"directions", "locus", "tension", "cycles"}
    for axes, values in zip(drawn["directions"].axes, (measured.stress, measured.r), strict=True):
        fit, points = (np.array(line.get_xydata()) for line in axes.lines)
        assert points.tolist() == [list(pair) for pair in values.items()]
        assert np.interp(points[:, 0], *fit.T) == pytest.approx(points[:, 1])
    assert [1.1, 1.1] in [line.get_xydata()[0].tolist() for line in drawn["locus"].axes[0].lines]
    for name, test in tests.items():
        points, fit = (np.array(line.get_xydata()) for line in drawn[name].axes[0].lines)
        assert np.array_equal(points, np.column_stack([test.strain, test.stress]))
        distance = np.abs((fit[:, None] - points) / [1e-6, 10.0]).max(axis=2).min(axis=0)
        assert (distance < 1.0).all()


def test_the_command(tmp_path):
    out, angles, tension = tmp_path / "o", EXAMPLES / "aa2090_directions.csv", EXAMPLES / "aa6016_tension.csv"
    given = ["metal", "fit", "--young", "69000", "--angles", str(angles), "--out", str(out)]
    run = CliRunner().invoke(app, given)
    assert run.exit_code == 0, run.output
    assert "uf.Hill48" in run.output
    assert "determined" in run.output
    assert {file.name for file in out.iterdir()} >= {"metal.toml", "metal.py", "constants.csv", "locus.png"}
    rows = (out / "constants.csv").read_text().splitlines()
    assert rows[0] == "fit,constant,value,standard_error"
    assert math.isfinite(float(rows[1].split(",")[3]))
    refused = CliRunner().invoke(app, ["metal", "fit", "--young", "69", "--tension", str(tension)])
    assert refused.exit_code == 1


@pytest.mark.parametrize(
    ("more", "where", "said"),
    [
        (["--yield-function", "yld2004"], "--yield-function", "--angles is missing"),
        (["--back-stress", "chaboche1"], "--back-stress", "--cycles is missing"),
        (["--largest-step", "0.01"], "--largest-step", "--cycles is missing"),
        (["--angles", str(EXAMPLES / "aa2090_directions.csv"), "--exponent", "8"], "--exponent", "only Yld2004"),
        (["--column", "stress=sigma"], "--column", "no file has a column"),
        (["--poisson", "0.6"], "--poisson", "between -1 and 0.5"),
    ],
)
def test_the_command_refuses_what_it_does_not_use(tmp_path, more, where, said):
    (tmp_path / "tension.csv").write_text("strain,stress\n0.001,70\n0.01,120\n0.03,160\n0.05,180\n0.1,210\n0.2,240\n")
    words = ["metal", "fit", "--young", "69000", "--tension", str(tmp_path / "tension.csv"), "--engineering", *more]
    refused = CliRunner().invoke(app, words)
    assert refused.exit_code == 1
    assert f"where:  {where}\n" in refused.output and said in refused.output


def test_the_library_is_listed_and_shown():
    listed, shown = (CliRunner().invoke(app, ["metal", *words]) for words in (["list"], ["show", "AA6016-T4"]))
    assert "AA6022-T4" in listed.output
    assert "DC04" in listed.output
    assert "0.895" not in shown.output
    assert 'library = "AA6016-T4", rolling = "x"' in shown.output
    assert "0.526" in shown.output


def test_a_rate_factor_survives_in_the_deck_and_in_python():
    law = uf.Metal(2e5, 0.3, hardening=uf.Swift(500.0, 0.01, 0.2), rate=uf.CowperSymonds(40.0, 5.0))
    assert 'rate = { factor = "CowperSymonds", reference = 40.0, exponent = 5.0 }' in deck_block(law)
    made: dict = {}
    exec(python_code(law), made)
    assert made["material"].rate == law.rate
