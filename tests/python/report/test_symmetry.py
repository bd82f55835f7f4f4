"""Planes of symmetry: which supports say one, and what is drawn of it."""

import numpy as np
import pytest

import umform as uf
from umform.processes.air_bending import AirBending
from umform.processes.air_bending.problem import build
from umform.report.symmetry import Mirror, is_symmetric, mirrors, mirrors_of_blank, whole
from umform.results.shape import Shape


def strip(*supports, cell="hex8", origin=(0.0, 0.0, 0.0)):
    mesh = uf.mesh.strip(8, 4, 0.5, (4, 2), cell=cell).moved(origin)
    model = uf.Model(mesh, "ANS3DEAS" if cell == "hex8" else "MI9K3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    for kind, nodes, directions in supports:
        getattr(model, kind)(nodes, directions)
    return model


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_a_half_and_a_quarter(cell):
    half, quarter = ("symmetry", "x0", "x"), ("symmetry", "y1", "y")
    assert mirrors(strip(half, cell=cell)) == [Mirror(0, 0.0)]
    assert mirrors(strip(half, quarter, cell=cell)) == [Mirror(0, 0.0), Mirror(1, 4.0)]
    assert mirrors(strip(half, cell=cell, origin=(3.0, 0.0, 0.0))) == [Mirror(0, 3.0)]


@pytest.mark.parametrize(
    "supports",
    [
        [],
        [("fix", "x0", "xyz")],  # a clamp
        [("symmetry", "x0_lower", "x")],  # an edge
        [("symmetry", "lower", "z")],  # on a table
    ],
)
def test_other_supports_are_no_symmetry(supports):
    assert mirrors(strip(*supports)) == []


def test_plane_strain_is_no_symmetry():
    model, _ = build(AirBending(stroke=6.0))
    assert mirrors(model) == [Mirror(0, 0.0)]
    model, _ = build(AirBending(stroke=6.0, width=20.0))
    assert mirrors(model) == [Mirror(0, 0.0), Mirror(1, 0.0)]


def test_an_edge_that_is_moved_sideways_is_no_symmetry_of_the_start():
    model = strip(("symmetry", "x0", "x"))
    model.prescribe("x1", "x", name="pull")
    assert mirrors(model) == [Mirror(0, 0.0)]
    clamped = strip(("fix", "x0", "xyz"))
    clamped.prescribe("x1", "x", name="pull")
    assert mirrors(clamped) == []


def test_an_edge_that_a_later_operation_holds_elsewhere_is_no_symmetry():
    model = strip()
    x, y, z = model.mesh.points.T
    model.u = (np.column_stack([z, y, -x]) - model.mesh.points).ravel()  # the strip stands on its edge x1
    model.supports.fix("x1", "x", here=True)
    assert mirrors(model) == []
    model.supports.fix("x0", "z", here=True)  # a plane of the strip as it stands
    assert mirrors(model) == [Mirror(2, 0.0)]
    assert mirrors_of_blank(model) == [Mirror(0, 0.0)]


def test_the_whole_shape_has_both_halves():
    model = strip(("symmetry", "x0", "x"), origin=(3.0, 0.0, 0.0))
    shape = Shape.displaced(model.mesh, np.zeros_like(model.mesh.points))
    both = whole(shape, mirrors(model))
    assert (both.points[:, 0].min(), both.points[:, 0].max()) == (-5.0, 11.0)
    assert len(both.quads) == 2 * len(shape.quads)


def test_a_tool_on_both_sides_is_its_own_image():
    box = (np.array([-5.0, -1.0, -5.0]), np.array([9.0, 1.0, 5.0]))
    for tool, symmetric in (
        (uf.VDie(8.0, 90.0, 1.0), True),
        (uf.Plane((0, 0, 0), "z"), True),
        (uf.Cylinder((0, 0, -3), "y", 2.0), True),
        (uf.Cylinder((4, 0, -3), "y", 2.0), False),
        (uf.Plane((0, 0, 0), (0.1, 0, 1)), False),
    ):
        assert is_symmetric(lambda x, tool=tool: tool.kernel().gap(x)[0], Mirror(0, 0.0), box) == symmetric, tool
