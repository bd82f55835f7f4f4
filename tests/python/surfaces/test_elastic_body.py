"""A tool as a body of elements: its face lies on the tool and looks out of it, its sides have their names."""

import numpy as np
import pytest

import umform as uf

CHANNEL = uf.Revolved(uf.Profile.from_corners([(30, 10), (10, 10), (10, 0), (30, 0)], [0, 3, 2, 0], closed=False))


def outward(tool, mesh):
    """Largest distance of the nodes of the face from the tool, and least cosine between its normals and the tool's."""
    nodes = mesh.points[mesh.nodes("upper")]
    corners = mesh.points[mesh.facets("upper")[:, :4]]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    n = tool.gap(corners.mean(axis=1))[1]
    return np.abs(tool.gap(nodes)[0]).max(), (normal * n).sum(axis=1) / np.linalg.norm(normal, axis=1)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("exchanged", [False, True])
def test_the_face_lies_on_the_tool_and_looks_out_of_it(cell, exchanged):
    die = uf.VDie(opening=12, angle=88, shoulder_radius=1.5)
    face, back = ((2, -4), (12, 0)), ((2, -15), (12, -15))
    if exchanged:
        face, back = face[::-1], back[::-1]
    mesh = die.elastic_body(face, back, size=0.5, layers=6, growth=4, width=2, wide=3, cell=cell)
    deviation, cosines = outward(die, mesh)
    assert deviation < 1e-12
    assert cosines.min() > np.cos(np.radians(2.6))
    assert np.all(mesh.points[mesh.nodes("lower"), 2] == -15.0)
    assert np.all(mesh.points[mesh.nodes("y0"), 1] == 0.0) and np.all(mesh.points[mesh.nodes("y1"), 1] == 2.0)
    first = mesh.points[mesh.nodes("x0"), 0]
    assert (first == 12.0).all() if exchanged else (first < 2.2).all()


def test_a_moved_punch():
    punch = uf.Punch(1.5, 84).moved((3.0, 0.0, 2.0))
    mesh = punch.elastic_body(((0, 0), (5, 6)), ((0, 20), (5, 20)), size=0.5, layers=4)
    deviation, cosines = outward(punch, mesh)
    assert deviation < 1e-12 and cosines.min() > 0.998
    assert np.isclose(mesh.points[mesh.nodes("upper"), 2].min(), 2.0, atol=1e-12)
    assert np.all(mesh.points[mesh.nodes("x0"), 0] == 3.0)


def test_a_sector_of_a_ring():
    mesh = CHANNEL.elastic_body(((25, 10), (10, 1)), ((25, 0), (15, 0)), size=1, layers=6, sector=45, wide=12)
    deviation, cosines = outward(CHANNEL, mesh)
    assert deviation < 1e-12 and cosines.min() > 0.998
    angle = np.degrees(np.arctan2(mesh.points[:, 1], mesh.points[:, 0]))
    assert np.allclose(angle[mesh.nodes("y0")], 0.0) and np.allclose(angle[mesh.nodes("y1")], 45.0)


def test_arcs_have_elements_of_an_angle_and_lines_of_a_length():
    die = uf.VDie(opening=12, angle=90, shoulder_radius=2)
    mesh = die.elastic_body(((2, -4), (12, 0)), ((2, -9), (12, -9)), size=1.0, layers=1, turn=9.0)
    on_arc = np.isclose(np.hypot(mesh.points[:, 0] - 6.8284271, mesh.points[:, 2] + 2.0), 2.0, atol=1e-6)
    assert on_arc.sum() == 2 * 6  # five elements of 9 degrees over 45
    x = np.unique(mesh.points[mesh.nodes("y0_upper"), 0])
    assert np.diff(x).max() <= 1.0 + 1e-12


def test_refusals():
    die = uf.VDie(opening=12, angle=88, shoulder_radius=1.5)
    with pytest.raises(uf.errors.InvalidValue, match="no profile"):
        die.counterpart(1.0).elastic_body(((0, 0), (1, 0)), ((0, 1), (1, 1)), size=1, layers=1)
    with pytest.raises(uf.errors.InvalidValue, match="no length"):
        die.elastic_body(((12, 0), (12, 5)), ((2, -9), (12, -9)), size=1, layers=1)
    for back in (((12, -9), (2, -9)), ((2, 4), (12, 4)), ((2, -4), (12, 0))):  # exchanged, in front, on the face
        with pytest.raises(uf.errors.InvalidValue, match=r"(?s)cross.*elastic_body, back.*order of those of the face"):
            die.elastic_body(((2, -4), (12, 0)), back, size=1, layers=1)
    with pytest.raises(uf.errors.InvalidValue, match="size"):
        die.elastic_body(((2, -4), (12, 0)), ((2, -9), (12, -9)), size=-1, layers=1)
    with pytest.raises(uf.errors.InvalidValue, match="an extruded tool has a width and no sector"):
        die.elastic_body(((2, -4), (12, 0)), ((2, -9), (12, -9)), size=1, layers=1, sector=30)
    with pytest.raises(uf.errors.InvalidValue, match="a revolved tool has a sector and no width"):
        CHANNEL.elastic_body(((25, 10), (10, 1)), ((25, 0), (15, 0)), size=1, layers=6, width=2)
