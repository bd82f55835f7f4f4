import numpy as np
import pytest
from pydantic import TypeAdapter

from umform.errors import EmptySet
from umform.mesh import FACES, strip
from umform.problem.selection import Selection, faces_of, nodes_of
from umform.problem.tagged import deck_type

MESH = strip(4.0, 2.0, 1.0, (4, 2), layers=2)
ADAPTER = TypeAdapter(deck_type(Selection))
INF = float("inf")


def nodes(selection):
    return nodes_of(MESH, ADAPTER.validate_python(selection))


def faces(selection):
    return faces_of(MESH, ADAPTER.validate_python(selection))


def test_nodes():
    x, y, z = MESH.points.T
    box = {"min": [1.0, -INF, 0.0], "max": [2.0, INF, INF]}
    inside = np.flatnonzero((x >= 1) & (x <= 2) & (z >= 0))
    assert np.array_equal(nodes(box), inside)
    assert np.array_equal(
        nodes({"intersection": ["x0_lower", "y0_lower"]}), np.flatnonzero((x == 0) & (y == 0) & (z < 0))
    )
    assert np.array_equal(nodes({"intersection": ["upper", box]}), np.intersect1d(inside, np.flatnonzero(z == 0.5)))
    assert np.allclose(MESH.points[nodes({"nearest": [3.9, 1.2, 0.4]})], [[4.0, 1.0, 0.5]])
    assert nodes({"ids": [3, 1]}).tolist() == [1, 3]
    assert np.array_equal(nodes("x1"), MESH.nodes("x1"))


def test_faces():
    x0_lower_layer = faces({"max": [0.0, INF, 0.0]})
    assert {FACES[number] for _, number in x0_lower_layer} == {"r0"}
    assert len(x0_lower_layer) == 2
    right_half = {"min": [2.0, -INF, -INF]}
    found = faces({"intersection": ["lower", right_half]})
    assert len(found) == 4
    assert set(map(tuple, found)) <= set(map(tuple, MESH.face_set("lower")))
    ((cell, number),) = faces({"nearest": [0.4, 0.6, 3.0]})
    assert FACES[number] == "upper"
    middle = MESH.points[MESH.connectivity[cell][4:]].mean(axis=0)
    assert np.allclose(middle, [0.5, 0.5, 0.5])
    ((cell, number),) = faces({"nearest": [5.0, 1.4, 0.2]})
    assert FACES[number] == "r1"
    ((cell, number),) = faces({"nearest": [1.0, 0.5, 0.3]})  # a face between two cells is nearer
    assert FACES[number] == "upper"
    assert faces({"ids": [[0, 1]]}).tolist() == [[0, 1]]


def test_what_selects_nothing_is_refused():
    with pytest.raises(EmptySet):
        nodes({"intersection": ["x0", "x1"]})
    with pytest.raises(EmptySet):
        faces({"min": [9.0, 0.0, 0.0]})
