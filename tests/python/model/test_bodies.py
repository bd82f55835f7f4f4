"""Several bodies in one model: a tailor-welded blank of two thicknesses and two laws against its two halves."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import resume, solve
from umform.analysis.steps import Move
from umform.errors import EmptySet, InvalidValue, ModelError
from umform.mesh import strip
from umform.model import Body, Model
from umform.results.fields import body_fields

MILD = mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(160.0, 1000.0))
STRONG = mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(320.0, 2000.0))
TIGHT = NewtonOptions(residual=1e-12, increment=1e-9)
LENGTH, WIDTH, THIN, THICK = 20.0, 5.0, 1.0, 1.6


def blank():
    """A strip whose right half is thicker, with the weld at x = 10; the lower face is plane."""
    mesh = strip(LENGTH, WIDTH, THIN, (8, 2))

    def thicker(x):
        y = x.copy()
        right = x[:, 0] > 0.5 * LENGTH + 1e-9
        y[right, 2] = (x[right, 2] + 0.5 * THIN) * THICK / THIN - 0.5 * THIN
        return y

    return mesh.transformed(thicker)


def left(x, y, z):
    return x < 0.5 * LENGTH


def right(x, y, z):
    return x > 0.5 * LENGTH


def welded(**keywords):
    bodies = [Body(material=MILD, cells=left, name="mild"), Body(material=STRONG, cells=right, name="strong")]
    return Model(strip(LENGTH, WIDTH, THIN, (8, 2)), bodies=bodies, **keywords)


def pulled_along_y(model, strain=0.02):
    """Stretched across the weld line's direction: both halves have the same strain along y, and free thickness."""
    model.symmetry(lambda x, y, z: y < 1e-9, "y")
    model.fix(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), "xz")
    model.fix(lambda x, y, z: (x > LENGTH - 1e-9) & (y < 1e-9) & (z < 0), "z")
    pull = model.prescribe(lambda x, y, z: y > WIDTH - 1e-9, "y", "pull")
    return solve(model, Move(pull, strain * WIDTH, steps=4), options=TIGHT)


def uniaxial_force(material, length, thickness, strain):
    """Force of one element in uniaxial tension along y."""
    model = Model(strip(length, WIDTH, thickness, (1, 1)), material=material)
    model.symmetry(lambda x, y, z: y < 1e-9, "y")
    model.symmetry(lambda x, y, z: x < 1e-9, "x")
    model.fix("lower", "z")
    pull = model.prescribe(lambda x, y, z: y > WIDTH - 1e-9, "y", "pull")
    return solve(model, Move(pull, strain * WIDTH, steps=4), options=TIGHT)["pull_force"]


def test_a_tailor_welded_blank_of_two_laws_carries_the_sum_of_its_halves():
    """Plane strain: each half is homogeneous but for the cells at the weld, and the forces add up."""

    def held(model):
        model.fix(lambda x, y, z: np.full(len(x), True), "x")
        model.fix("lower", "z")
        return pulled(model)

    def pulled(model):
        model.symmetry(lambda x, y, z: y < 1e-9, "y")
        pull = model.prescribe(lambda x, y, z: y > WIDTH - 1e-9, "y", "pull")
        return solve(model, Move(pull, 0.02 * WIDTH, steps=4), options=TIGHT)

    def half(material):
        return held(Model(strip(0.5 * LENGTH, WIDTH, THIN, (1, 1)), material=material))["pull_force"]

    whole = held(Model(strip(LENGTH, WIDTH, THIN, (8, 2)), bodies=[
        Body("DISP3DEAS", material=MILD, cells=left, name="mild"),
        Body("DISP3DEAS", material=STRONG, cells=right, name="strong"),
    ]))  # fmt: skip
    # The halves want other thicknesses; the cells at the weld are between them.
    np.testing.assert_allclose(whole["pull_force"][1:], (half(MILD) + half(STRONG))[1:], rtol=2e-3)


def test_two_bodies_of_one_law_are_one_body_to_the_last_bit():
    cells = np.arange(16)
    two = Model(strip(LENGTH, WIDTH, THIN, (8, 2)), bodies=[
        Body(material=MILD, cells=cells[:8], name="a"), Body(material=MILD, cells=cells[8:], name="b"),
    ])  # fmt: skip
    one = Model(strip(LENGTH, WIDTH, THIN, (8, 2)), material=MILD)
    ours, theirs = pulled_along_y(two), pulled_along_y(one)
    np.testing.assert_allclose(ours["pull_force"], theirs["pull_force"], rtol=1e-12)
    np.testing.assert_allclose(two.u, one.u, atol=1e-12)
    np.testing.assert_array_equal(ours["iterations"], theirs["iterations"])
    for name, field in ours.frames[-1].cells.items():
        np.testing.assert_allclose(field, theirs.frames[-1].cells[name], atol=1e-8 * np.abs(field).max(), err_msg=name)


def test_a_blank_of_two_thicknesses_and_two_laws_closes_its_balance_and_names_its_fields():
    mesh = blank()
    model = Model(mesh, bodies=[
        Body("ANS3DEAS", material=MILD, cells=left, name="mild"),
        Body("ANS3DEAS", material=mt.SVK(E=210e3, nu=0.3), cells=right, name="elastic", thickness_points=2),
    ])  # fmt: skip
    result = pulled_along_y(model, 0.01)
    assert abs(result.balance().drift[-1]) < 0.01  # four increments over the first yield
    plastic = result.frames[-1].cells["plastic_strain_max"]
    assert (plastic[model.bodies[0].cells] > 1e-3).all()
    assert (plastic[model.bodies[1].cells] == 0.0).all()
    mild = body_fields(model.bodies[0], model.u)
    assert mild.eqps is not None
    assert body_fields(model.bodies[1], model.u).eqps is None
    # Far from the weld each half is in uniaxial tension of its own: the force is the sum of both.
    expected = [
        uniaxial_force(MILD, 0.5 * LENGTH, THIN, 0.01)[-1],
        uniaxial_force(mt.SVK(E=210e3, nu=0.3), 0.5 * LENGTH, THICK, 0.01)[-1],
    ]
    tapered = 0.5 * LENGTH / 4 * 0.5 * (THICK - THIN) / (0.5 * LENGTH * THICK)  # the cells at the weld grow thicker
    expected[1] *= 1.0 - tapered
    assert result["pull_force"][-1] == pytest.approx(sum(expected), rel=0.003)


def test_a_run_of_two_bodies_goes_on_from_its_checkpoint(tmp_path, same_state):
    def steps(model):
        model.symmetry(lambda x, y, z: y < 1e-9, "y")
        model.fix(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), "xz")
        model.fix(lambda x, y, z: (x > LENGTH - 1e-9) & (y < 1e-9) & (z < 0), "z")
        pull = model.prescribe(lambda x, y, z: y > WIDTH - 1e-9, "y", "pull")
        return [Move(pull, 0.02, steps=2), Move(pull, 0.1, steps=3)]

    whole, stopped, taken_up = welded(), welded(), welded()
    solve(whole, steps(whole), frames=0)
    both = steps(stopped)
    solve(stopped, both[0], frames=0, checkpoint=tmp_path / "run.h5")
    with pytest.raises(Exception, match="another run"):
        resume(tmp_path / "run.h5", taken_up, steps(taken_up), frames=0)
    again = welded()
    solve(again, steps(again), frames=0, checkpoint=tmp_path / "all.h5", every=0.0)
    resumed = welded()
    resume(tmp_path / "all.h5", resumed, steps(resumed), frames=0)
    assert same_state(resumed.system.snapshot(), whole.system.snapshot())


# What is refused ---------------------------------------------------------------------------------------------


def test_each_cell_belongs_to_one_body():
    mesh = strip(LENGTH, WIDTH, THIN, (8, 2))
    with pytest.raises(InvalidValue, match="each cell belongs to one body"):
        Model(mesh, bodies=[Body(material=MILD, cells=left, name="a")])
    with pytest.raises(InvalidValue, match="each cell belongs to one body"):
        Model(mesh, bodies=[Body(material=MILD, name="a"), Body(material=STRONG, cells=right, name="b")])
    with pytest.raises(InvalidValue, match="the same name"):
        Model(mesh, bodies=[Body(material=MILD, cells=left), Body(material=STRONG, cells=right)])
    with pytest.raises(EmptySet):
        Model(mesh, bodies=[Body(material=MILD, cells=lambda x, y, z: x > 99.0)])
    with pytest.raises(InvalidValue, match="does not exist"):
        Model(mesh, bodies=[Body(material=MILD, cells=[0, 16])])
    for cells in (lambda x, y, z: x, lambda x, y, z: (x > 1.0)[:3]):
        with pytest.raises(InvalidValue, match="returns True or False for each cell"):
            Model(mesh, bodies=[Body(material=MILD, cells=cells)])
    with pytest.raises(InvalidValue, match="whole numbers, a mask"):
        Model(mesh, bodies=[Body(material=MILD, cells=[0.5, 2.7])])
    with pytest.raises(InvalidValue, match=r"(?s)rolling must be one vector.*x"):
        Model(mesh, material=MILD, rolling="x")
    with pytest.raises(InvalidValue, match="bodies, or element and material"):
        Model(mesh, material=MILD, bodies=[Body(material=MILD)])
    with pytest.raises(InvalidValue, match="element, thickness_points"):
        Model(mesh, "BEND8", bodies=[Body(material=MILD)], thickness_points=7)
    with pytest.raises(InvalidValue, match="a list of bodies"):
        Model(mesh, bodies=Body(material=MILD))
    shared = Body(material=MILD, cells=left, name="a")
    with pytest.raises(InvalidValue, match="each cell belongs to one body"):
        Model(mesh, bodies=[shared])
    with pytest.raises(EmptySet):
        Model(mesh, bodies=[shared, Body(material=STRONG, cells=lambda x, y, z: x > 99.0, name="b")])
    Model(mesh, bodies=[shared, Body(material=STRONG, cells=right, name="b")])  # a third try
    shared = Body(material=MILD)
    Model(mesh, bodies=[shared])
    with pytest.raises(InvalidValue, match="a body belongs to one model"):
        Model(mesh, bodies=[shared])


def test_what_only_one_body_has_is_refused_by_name():
    with pytest.raises(ModelError, match="several bodies"):
        _ = welded().bodies.only.material
