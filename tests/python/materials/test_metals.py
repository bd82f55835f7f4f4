"""Metals in elements, and what is refused."""

from __future__ import annotations

import contextlib
import math

import cards
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import umform as uf
from umform import materials as mt
from umform.errors import InvalidValue
from umform_book.newton_order import measure

STEEL, SPCC = cards.STEEL, cards.SPCC


def pulled(metal, rolling=(1, 0, 0), **options):
    cube = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1))
    model = uf.Model(cube, "ANS3DEAS", material=metal, rolling=rolling)
    for name, axis in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(name, axis)
    pull = model.prescribe("x1", "x", "pull")
    return model, uf.solve(model, uf.Move(pull, to=0.05, steps=5), progress=False, **options)


@pytest.mark.parametrize("name", ["hill48", "aa2090"])
def test_r_value_from_one_element(name):
    """Pulled along and across the rolling direction, which is all that turns."""
    metal = mt.Metal(**cards.ALUMINIUM, hardening=mt.Voce(130.0, 300.0, 12.0), yield_function=cards.FUNCTIONS[name])
    for rolling, angle in (((1, 0, 0), 0.0), ((0, 1, 0), 90.0)):
        model, _ = pulled(metal, rolling)
        history = uf.fields.point_fields(model).history["plastic_strain"][0, 0]
        across = history[1 if angle == 0.0 else 0]
        assert across / history[2] == pytest.approx(cards.bar(metal.yield_function, angle)[1], rel=1e-5)


@pytest.mark.parametrize("card", ["hill48, voce, fixed", "aa2090, swift, two", "hill48, swift, two, falling"])
def test_newton_is_quadratic_and_the_balance_closes(card):
    """A strip that is bent and pulled, at 30 degrees to the rolling direction."""
    strip = uf.mesh.strip(length=8.0, width=4.0, thickness=1.0, cells=(4, 2))
    model = uf.Model(strip, "ANS3DEAS", material=cards.CARDS[card], rolling=(math.cos(0.5), math.sin(0.5), 0))
    model.fix("x0")
    pulls = [model.prescribe("x1", axis, f"pull_{axis}") for axis in "xz"]
    result = uf.solve(model, [uf.Move(pulls[1], to=1.0, steps=5), uf.Move(pulls[0], to=0.3, steps=5)], progress=False)
    assert measure(result.iterations).order > 1.7
    assert len(result.rows) == 11  # no increment was cut
    assert uf.fields.point_fields(model).eqps.max() > 0.05
    assert np.abs(result.balance().drift).max() < 0.02
    assert set(cards.CARDS[card].law().history_variables) == set(uf.fields.point_fields(model).history)


def test_rotation_of_the_sheet_changes_nothing():
    """The rolling direction turns with the mesh: same strains, same plastic strain in the axes of the sheet."""
    metal, ends = cards.CARDS["aa2090, swift, two"], []
    Q = Rotation.from_rotvec([0.3, -0.5, 0.7]).as_matrix()
    for turn in (np.eye(3), Q):
        mesh = uf.mesh.strip(length=1.0, width=1.0, thickness=0.2, cells=(1, 1))
        x = mesh.points.copy()
        F = np.array([[1.03, 0.02, 0.01], [0.0, 0.99, 0.0], [0.01, 0.0, 0.98]])
        mesh = uf.Mesh(x @ turn.T, mesh.cells)
        model = uf.Model(mesh, "ANS3DEAS", material=metal, rolling=turn @ np.array([0.8, 0.6, 0.0]))
        model.fix([0])
        forces = model.evaluate(((x @ F.T) @ turn.T - x @ turn.T).ravel())
        ends.append(forces.residual.reshape(-1, 3) @ turn)
    assert np.abs(ends[1] - ends[0]).max() < 1e-10 * np.abs(ends[0]).max()


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: mt.Hill48(r0=-0.5, r45=1, r90=1), "r-value along the rolling direction must be positive"),
        (lambda: mt.Hill48.from_stresses(1, 1, 1.9, 2.4), "not convex"),
        (lambda: mt.Hill48.from_stresses(1, 2.5, 1, 1), "not convex"),
        (lambda: mt.Hosford(1.5), "from 2 to 20"),
        (lambda: mt.Hosford(math.nan), "from 2 to 20"),
        (lambda: mt.Chaboche([(-3000.0, 30.0)]), "C must be positive"),
        (lambda: mt.Chaboche([]), "one to four"),
        (lambda: mt.Chaboche((3000.0, 30.0)), "(?s)one to four.*a single pair that is not in a list"),
        (lambda: mt.Table(0.1, 200.0), "a column of numbers"),
        (lambda: mt.Table(("strain", "0.1"), (200.0, 300.0)), "a column of numbers"),
        (lambda: mt.Chaboche([(1.0, 1.0)] * 5), "one to four"),
        (lambda: mt.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=-9.0, m=12.0, h=0.5), "must be positive"),
        (
            lambda: mt.Metal(**STEEL, hardening=mt.Perfect(200.0), back_stress=SPCC),
            "larger than the yield surface",
        ),
        (lambda: mt.Metal(**STEEL, hardening=mt.Linear(100.0, 1.0), back_stress=SPCC), "constant size"),
        (lambda: mt.FallingModulus(0.0, 30.0), "must be positive"),
        (
            lambda: mt.Metal(**STEEL, hardening=mt.Perfect(1.0), modulus=mt.FallingModulus(220e3, 3.0)),
            "must fall",
        ),
        (
            lambda: mt.Metal(**STEEL, hardening=mt.Perfect(1.0), yield_function="Hill48"),
            "must be a yield function",
        ),
        (lambda: mt.Yld2004(mt.Transformation(shear23=0.0), mt.Transformation(shear23=0.0)), "never flows"),
        (lambda: mt.Metal(**STEEL, hardening=160.0), "must be a hardening curve"),
    ],
)
def test_bad_input(make, text):
    with pytest.raises(InvalidValue, match=text):
        make()


def test_directions_ask_for_the_rolling_direction():
    mesh = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1))
    with pytest.raises(InvalidValue, match="rolling direction"):
        uf.Model(mesh, "ANS3DEAS", material=cards.CARDS["hill48, voce, fixed"])
    uf.Model(mesh, "ANS3DEAS", material=cards.CARDS["hosford, voce, fixed"])  # isotropic


def test_return_maps_in_stages_are_counted(rng):
    """A hardening curve with a step, at which Newton's method stalls; a smooth one needs no stages."""
    strains = rng.normal(size=(400, 6))
    strains *= 0.004 / np.linalg.norm(strains, axis=1)[:, None]
    step = mt.Table([0.0, 0.001, 0.0010001, 0.01], [100.0, 100.0, 400.0, 400.0])
    counted = []
    for curve in (step, mt.Voce(100.0, 300.0, 12.0)):
        law = mt.Metal(E=210e3, nu=0.3, hardening=curve, yield_function=mt.Hosford(20)).law()
        for strain in strains:
            with contextlib.suppress(ValueError, InvalidValue, RuntimeError):  # stages fail at the step, too
                law.respond(strain[None], law.initial()[None])
        counted.append(law.staged_returns)
    assert 0 < counted[0] <= len(strains)
    assert counted[1] == 0


def test_a_run_tells_of_return_maps_in_stages(monkeypatch, caplog):
    """With each increment in the log, once as a warning, in all in the attempts."""
    numbers = iter([10, 10, 13, 13, 15, 15])  # as the run begins, and behind each of five increments
    monkeypatch.setattr("umform.analysis.steps.run_state.Run._staged", lambda run: next(numbers))
    metal = mt.Metal(E=210e3, nu=0.3, hardening=mt.Voce(100.0, 300.0, 12.0), yield_function=mt.Hosford(8))
    with caplog.at_level("INFO", logger="umform.analysis.steps"):
        _, result = pulled(metal)
    assert result.timing.attempts.staged == result.timing.attempts.record()["staged"] == 5
    assert caplog.text.count("return maps in stages at") == 2
    told = [warning for warning in result.warnings if "stages of a shrinking yield surface at 3 points" in warning]
    assert len(told) == 1
    assert told[0].startswith("step 1, time 0.4")
