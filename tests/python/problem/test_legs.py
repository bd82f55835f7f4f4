"""The angle between the legs of a bend, as a measure of a deck."""

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.problem.measured import Taken
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.problem import problem_of
from umform.results.forming import Leg, angle_between

CASE = AirBending(stroke=1.5, layers=1, elements_per_thickness=1, increment=0.0125, element="BEND8")


def strip(bend, *, whole, cell="hex8"):
    """A strip of 40 x 4 x 1 whose right and left ends are turned up about y: the angle is 180 - 2 bend."""

    def bent(X):
        x, y, z = X.T
        turn = np.radians(bend) * np.clip(np.abs(x) / 5.0, 0.0, 1.0) * np.sign(x)
        way = np.clip(np.abs(x) - 5.0, 0.0, None) * np.sign(x)
        k = np.radians(bend) / 5.0
        # the middle of the bend is an arc of the radius 1 / k
        return np.column_stack(
            [
                np.sin(turn) / k + way * np.cos(turn) - z * np.sin(turn),
                y,
                (1.0 - np.cos(turn)) / k + way * np.sin(turn) + z * np.cos(turn),
            ]
        )

    sheet = uf.mesh.strip(40.0 if whole else 20.0, 4.0, 1.0, (40 if whole else 20, 1), cell=cell)
    shift = np.array([20.0 if whole else 0.0, 0.0, 0.0])
    sheet = sheet.transformed(lambda X: X - shift)
    model = uf.Model(sheet, "BEND18" if cell == "hex18" else "BEND8", material=uf.SVK(E=210e3, nu=0.3))
    if not whole:
        model.symmetry("x0", normal="x")
    return model, bent(sheet.points) - sheet.points


def measured(model, u, **keys):
    from umform.problem.measures.legs import Angle
    from umform.report.symmetry import mirrors

    part = Angle(kind="angle", **keys)
    legs = part._legs(model, part._cut(model, u), mirrors(model))
    one = legs[0].direction
    return angle_between(one, legs[1].direction if len(legs) == 2 else one * [-1.0, 1.0]), legs


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("bend", [0.0, 20.0, 45.0, 80.0])
def test_a_known_angle_of_half_a_bend_and_of_a_whole_one(bend, whole, cell):
    model, u = strip(max(bend, 1e-12), whole=whole, cell=cell)
    angle, legs = measured(model, u, leg=4.0)
    assert angle == pytest.approx(180.0 - 2.0 * bend, abs=1e-6)
    assert len(legs) == 1 + whole
    assert max(leg.deviation for leg in legs) < 1e-9


def test_a_leg_that_reaches_into_the_bend_is_bowed():
    model, u = strip(45.0, whole=False)
    angle, (leg,) = measured(model, u, leg=18.0)
    assert angle > 90.5 and leg.deviation > 0.05


def test_the_leg_has_two_thicknesses_or_an_element():
    model, u = strip(30.0, whole=False)
    assert len(measured(model, u)[1][0].points) == 3
    assert len(measured(model, u, leg=0.1)[1][0].points) == 2


def test_a_leg_longer_than_the_section_is_refused():
    with pytest.raises(InvalidValue, match="a leg is a part of its section") as caught:
        Leg.of(np.arange(4.0), np.zeros((4, 2)), 3.5)
    assert caught.value.remedy == "less than 1.5, half of the section"


@pytest.mark.parametrize(("leg", "what"), [(100.0, "a part of its section"), (25.0, "do not overlap")])
def test_legs_that_overlap_are_refused_before_the_run(leg, what):
    from umform.problem.measures.legs import Angle

    model, _ = strip(30.0, whole=True)
    with pytest.raises(InvalidValue, match=what):
        Angle(kind="angle", leg=leg).check(model, released=True)


@pytest.fixture(scope="module")
def problem():
    deck = problem_of(CASE)
    return deck.with_({f"steps.{len(deck.contents.steps) - 1}.tolerance": 1e-6})


def numbers(problem):
    made = problem.build()
    taken = Taken.of(problem, made, made.solve(progress=False), complete=True)
    return {one.name: one.value for one in taken.quantities}


def test_the_deck_of_a_bend_reports_the_angles_of_the_bend():
    deck, bend = numbers(problem_of(CASE)), air_bending(CASE).measures
    assert deck["legs.angle.formed"] == pytest.approx(bend.loaded_angle, abs=1e-8)
    assert deck["legs.angle.released"] == pytest.approx(bend.angle, abs=1e-8)
    assert deck["legs.springback.released"] == pytest.approx(bend.springback, abs=1e-8)


def test_its_derivatives_are_those_of_whole_runs(problem):
    path = "material.hardening.strength"
    of = ["legs.angle.formed", "legs.angle.released"]
    found = uf.derivatives(problem, [path], of, progress=False)
    at = float(next(one.value for one in problem.paths() if one.path == path))
    low, high = (numbers(problem.with_({path: at + change})) for change in (-0.2, 0.2))
    for name in of:
        assert found[name, path].value == pytest.approx((high[name] - low[name]) / 0.4, rel=5e-3)


def test_the_thickness_of_the_deck_of_a_bend_can_be_varied():
    deck = problem_of(CASE)
    assert "mesh.thickness" in [one.path for one in deck.paths()]
    thick = deck.with_({"mesh.thickness": 2.5}).build().model.mesh.points
    plain = deck.build().model.mesh.points
    assert np.array_equal(thick[:, :2], plain[:, :2])
    np.testing.assert_allclose(thick[:, 2], 1.25 * plain[:, 2], rtol=1e-15)


def test_a_grid_scales_its_layers_to_a_thickness():
    lines = ([0.0, 1.0], [0.0, 1.0], [3.0, 3.3, 4.0])
    z = np.unique(uf.mesh.grid(*lines, thickness=2.0).points[:, 2])
    np.testing.assert_allclose(z, [3.0, 3.6, 5.0], rtol=1e-15)
    assert np.array_equal(uf.mesh.grid(*lines, thickness=1.0).points, uf.mesh.grid(*lines).points)
    with pytest.raises(InvalidValue, match="thickness"):
        uf.mesh.grid(*lines, thickness=0.0)
