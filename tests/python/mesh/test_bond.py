"""Sheets bonded at their nodes."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.model.contact.encounter import Layer, sheet_thickness
from umform.model.contact.layers import layers_behind

SOFT, STIFF = uf.SVK(E=70e3, nu=0.0), uf.SVK(E=210e3, nu=0.0)
LAWS = {"a": SOFT, "b": STIFF}


def strip(cells=(8, 1), thickness=0.2, cell="hex8"):
    return uf.mesh.strip(10.0, 1.0, thickness, cells, cell=cell)


def lifted(mesh, z=0.2, x=0.0):
    return mesh.moved((x, 0.0, z))


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_bonded_faces_share_their_nodes_and_lie_inside(cell):
    one = strip(cell=cell)
    loose = uf.mesh.together(a=one, b=lifted(one))
    clad = uf.mesh.bond(loose, "upper of a", "lower of b")
    layered = uf.mesh.strip(10.0, 1.0, 0.4, (8, 1), layers=2, cell=cell)
    assert len(clad.points) == len(layered.points)
    np.testing.assert_array_equal(clad.points[clad.connectivity], loose.points[loose.connectivity])
    assert set(loose.faces) - set(clad.faces) == {"upper of a", "lower of b"}
    np.testing.assert_array_equal(clad.nodes("upper of a"), clad.nodes("lower of b"))
    np.testing.assert_array_equal(clad.nodes("a")[np.isin(clad.nodes("a"), clad.nodes("b"))], clad.nodes("lower of b"))


def test_a_patch_leaves_the_rest_of_the_face_outside():
    base = strip(cells=(8, 2))
    patch = uf.mesh.strip(5.0, 0.5, 0.2, (4, 1))
    patched = uf.mesh.bond(uf.mesh.together(base=base, patch=lifted(patch)), "upper of base", "lower of patch")
    assert sheet_thickness(patched) == pytest.approx(0.2)
    assert sheet_thickness(patched, patched.face_set("lower of base")) == pytest.approx(0.2)
    assert sheet_thickness(patched, patched.face_set("upper of patch")) == pytest.approx(0.4)
    assert len(patched.faces["upper of base"]) == 16 - 4
    assert "lower of patch" not in patched.faces


def test_a_welded_blank_is_a_bar_of_two_metals_in_series():
    one = strip()
    blank = uf.mesh.together(a=one, b=lifted(one, z=0.0, x=10.0))
    blank = uf.mesh.bond(blank, "x1 of a", "x0 of b")
    model = uf.Model(blank, bodies=[uf.Body(material=of, cells=name, name=name) for name, of in LAWS.items()])
    model.fix("x0 of a")
    end = model.prescribe("x1 of b", "x", "end")
    result = uf.solve(model, uf.Move(end, to=1e-3), progress=False)
    expected = 1e-3 * 0.2 / (10.0 / 70e3 + 10.0 / 210e3)
    assert result["end_force"][-1] == pytest.approx(expected, rel=1e-4)


def clad_strip(cell="hex8", element="EAS3DEAS"):
    """0.2 of the soft metal below 0.1 of the stiff one."""
    lower, upper = strip((20, 1), 0.2, cell), strip((20, 1), 0.1, cell)
    clad = uf.mesh.bond(uf.mesh.together(a=lower, b=lifted(upper, 0.15)), "upper of a", "lower of b")
    return uf.Model(clad, bodies=[uf.Body(element, material=of, cells=name, name=name) for name, of in LAWS.items()])


@pytest.mark.parametrize(("cell", "element"), [("hex8", "EAS3DEAS"), ("hex18", "BEND18")])
def test_a_clad_strip_bends_as_a_composite_beam(cell, element):
    """F = 3 E I w / l³, with the stiffness E I of the transformed section."""
    model = clad_strip(cell, element)
    for name in ("x0 of a", "x0 of b"):
        model.fix(name)
    tip = model.prescribe("x1_upper of b", "z", "tip")
    result = uf.solve(model, uf.Move(tip, to=1e-3), progress=False)
    EA, ES = 70e3 * 0.2 + 210e3 * 0.1, 210e3 * 0.1 * 0.15
    EI = 70e3 * 0.2**3 / 12.0 + 210e3 * (0.1**3 / 12.0 + 0.1 * 0.15**2) - ES**2 / EA
    assert result["tip_force"][-1] == pytest.approx(3.0 * EI * 1e-3 / 10.0**3, rel=5e-3)


def test_the_layers_behind_a_face():
    """A penalty follows from the layer at the face; bodies side by side are no layers."""
    model = clad_strip()
    lower, upper = (model.mesh.face_set(name)[:, 0] for name in ("lower of a", "upper of b"))
    assert [(one.material, pytest.approx(one.thickness)) for one in layers_behind(model.bodies, lower)] == [
        (SOFT, 0.2),
        (STIFF, 0.1),
    ]
    assert [one.material for one in layers_behind(model.bodies, upper)] == [STIFF, SOFT]
    beside = [
        uf.Body(material=SOFT, cells=lambda x, y, z: x < 4.0, name="a"),
        uf.Body(material=STIFF, cells=lambda x, y, z: x > 4.0, name="b"),
    ]
    model = uf.Model(strip(), bodies=beside)
    assert layers_behind(model.bodies, model.mesh.face_set("lower")[:, 0]) == [Layer(STIFF)]


def test_layers_of_different_thickness_add_up_and_each_face_has_its_own():
    """eq. (4.320): 1 / penalty is the mean of the softness of both sides, that of clad metal of its layer."""
    thin = uf.mesh.strip(10.0, 1.0, 0.2, (20, 1), layers=2)
    stack = uf.mesh.together(a=thin, b=lifted(strip((20, 1), 0.4), 0.3))
    assert sheet_thickness(uf.mesh.bond(stack, "upper of a", "lower of b")) == pytest.approx(0.6)
    lower, upper = strip((20, 1), 0.2), strip((20, 1), 0.1)
    parts = uf.mesh.together(a=lower, b=lifted(upper, 0.15), c=lifted(upper, 0.25))
    mesh = uf.mesh.bond(parts, "upper of a", "lower of b")
    laws = LAWS | {"c": STIFF}
    model = uf.Model(mesh, bodies=[uf.Body(material=of, cells=name, name=name) for name, of in laws.items()])
    pressed = model.sheet_contact("upper of b", "lower of c")
    assert pressed.penalty == pytest.approx(1.0 / (50.0 * (0.1 + 0.1) / 210e3), rel=1e-4)


def test_faces_that_do_not_match_are_refused():
    one = strip()

    def refused(other, text):
        with pytest.raises(InvalidValue, match="have the same nodes") as found:
            uf.mesh.bond(uf.mesh.together(a=one, b=other), "upper of a", "lower of b")
        assert text in str(found.value)

    refused(lifted(strip((7, 1))), "the next node is 0.536 away")
    refused(lifted(one, 0.3), "the next node is 0.1 away")
    refused(lifted(strip((4, 1))), "several faces of the other sheet")


@pytest.mark.parametrize(
    ("z", "faces", "text"),
    [
        (0.0, ("upper of a", "upper of b"), "both cells lie on one side"),
        (0.2, ("upper of a", "upper of a"), "both cells lie on one side"),
        (0.2, ("upper of a", "upper of b"), "turned over"),
    ],
)
def test_faces_that_do_not_look_at_each_other_are_refused(z, faces, text):
    one = strip()
    other = lifted(one, z)
    if "turned" in text:
        other = one.transformed(lambda X: X * [1.0, -1.0, -1.0] + [0.0, 1.0, z])
    with pytest.raises(InvalidValue, match="look at each other") as found:
        uf.mesh.bond(uf.mesh.together(a=one, b=other), *faces)
    assert text in str(found.value)
