"""An element that is turned inside out has no residual, whatever its law says of its strain."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.elements import element as catalogue_element
from umform.errors import NoConvergence
from umform.mesh import strip
from umform.model import Model

ELEMENTS = ["DISP3D", "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS", "BEND18"]
LAWS = ["svk", "neo-hooke", "neo-hooke-power", "j2"]


def pressed(element, law, cells=(3, 1)):
    """A strip 1 thick whose lower face is held; its upper face moves down as a whole."""
    cell = "hex18" if element in ("MI9K3DEAS", "BEND18") else "hex8"
    model = Model(strip(3.0, 1.0, 1.0, cells, cell=cell), element, material=law)
    model.fix("lower")
    model.fix("upper", "y")
    return model, model.prescribe("upper", "z", "press")


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("law", LAWS)
def test_a_mirror_image_is_no_solution(materials, element, law):
    """Its strain is zero, so that only the determinant tells."""
    model, _ = pressed(element, materials[law])
    mirrored = np.zeros_like(model.mesh.points)
    mirrored[:, 2] = -2.0 * model.mesh.points[:, 2]
    evaluation = model.evaluate(mirrored.ravel())
    assert evaluation.failed == 0
    assert "turned inside out" in evaluation.failure
    assert "cell" not in evaluation.failure
    turned = mirrored.copy()
    turned[:, 1] = -2.0 * model.mesh.points[:, 1]  # half a turn about x
    assert model.evaluate(turned.ravel()).failed == -1


@pytest.mark.parametrize("steps", [1, 2])
@pytest.mark.parametrize("element", ["DISP3D", "ANS3DEAS"])
@pytest.mark.parametrize("law", LAWS)
def test_a_sheet_pressed_through_itself_ends_with_its_cell(materials, element, law, steps):
    made = catalogue_element(element, thickness_order=1 if element == "ANS3DEAS" else None)
    model, press = pressed(made, materials[law])
    with pytest.raises(NoConvergence) as caught:
        solve(model, Move(press, -2.0, steps=steps, cuts=3), frames=0, progress=False)
    assert "cell 0 is " in caught.value.cause
    # The enhanced parameters of a plastic element may leave the domain of the law before it is flat.
    assert "turned inside out" in caught.value.cause or (law, element) == ("j2", "ANS3DEAS")
    assert press.value > -1.0
    F = model.bodies.only.block.point_fields(model.u)[3]
    assert np.linalg.det(F).min() > 0.0


def test_one_element_of_many_is_named(materials):
    model, _ = pressed("ANS3DEAS", materials["svk"], cells=(7, 1))
    u = np.zeros_like(model.mesh.points)
    u[model.mesh.nodes("x1"), 2] = -2.0 * model.mesh.points[model.mesh.nodes("x1"), 2]
    evaluation = model.evaluate(u.ravel())
    assert evaluation.failed == 6
    with pytest.raises(ValueError, match="cell 6 is turned inside out"):
        model.bodies.only.block.element(6, u.ravel())
    with pytest.raises(ValueError, match="cell 6 is turned inside out"):
        model.bodies.only.block.point_fields(u.ravel())
    model.bodies.only.block.element(5, u.ravel())


def test_a_law_without_an_answer_is_told_from_an_element_inside_out():
    """A yield curve so steep that the return map finds no stress, in an element that is all right otherwise."""
    steep = mt.Table(
        tuple([0.0] + [1e-300 * 200.0**k for k in range(1, 130)]), tuple(100.0 + 10.0 * k for k in range(130))
    )
    model, _ = pressed("ANS3DEAS", mt.J2(kappa=175e3, mu=80.77e3, hardening=steep))
    u = np.zeros_like(model.mesh.points)
    u[:, 2] = -0.0095 * (model.mesh.points[:, 2] + 0.5)
    evaluation = model.evaluate(u.ravel())
    assert evaluation.failed == 0
    assert "found no stress" in evaluation.failure
    assert model.evaluate(0.0 * u.ravel()).failed == -1
