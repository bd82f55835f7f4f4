"""Meshes: generators, sets, faces, and every way in which a mesh is refused."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from umform import _core
from umform.errors import (
    EmptySet,
    FoldedElement,
    InvalidValue,
    InvertedElement,
    MeshError,
    NotFinite,
    UnknownSet,
    WrongCellType,
    WrongNodeOrder,
)
from umform.materials import SVK
from umform.mesh import FACES, Mesh, graded, grid, plate, quality, strip
from umform.mesh.quality import jacobians
from umform.model import Model

CELLS = ("hex8", "hex18")


def volumes(made):
    x, w = _core.gauss(3)
    r, s, t = (a.ravel() for a in np.meshgrid(x, x, x, indexing="ij"))
    weight = np.einsum("i,j,k->ijk", w, w, w).ravel()
    _, dN = _core.shell_functions(made.connectivity.shape[1], np.stack([r, s, t], axis=1))
    J = np.linalg.det(np.einsum("qia,eak->eqik", dN, made.points[made.connectivity]))
    return J @ weight


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("layers", [1, 3])
def test_strip_has_its_size_cells_and_sets(cell, layers):
    made = strip(6.0, 4.0, 0.6, (3, 2), cell=cell, layers=layers)
    per = 1 if cell == "hex8" else 2
    assert made.cell == cell
    assert made.connectivity.shape == (3 * 2 * layers, 8 if cell == "hex8" else 18)
    assert len(made.points) == (3 * per + 1) * (2 * per + 1) * (layers + 1)
    np.testing.assert_allclose(made.points.min(axis=0), [0, 0, -0.3])
    np.testing.assert_allclose(made.points.max(axis=0), [6, 4, 0.3])
    np.testing.assert_allclose(volumes(made), 6 * 4 * 0.6 / (6 * layers), rtol=1e-13)
    planes = {"x0": (0, 0), "x1": (0, 6), "y0": (1, 0), "y1": (1, 4), "lower": (2, -0.3), "upper": (2, 0.3)}
    for name, (axis, value) in planes.items():
        on_plane = np.flatnonzero(np.isclose(made.points[:, axis], value))
        np.testing.assert_array_equal(made.nodes(name), on_plane)
        for cell_number, face in made.face_set(name):
            assert np.isin(made.nodes_on(np.array([[cell_number, face]])), on_plane).all()
    for name in ("x0", "x1", "y0", "y1"):
        for side in ("lower", "upper"):
            expected = np.intersect1d(made.nodes(name), made.nodes(side))
            np.testing.assert_array_equal(made.nodes(f"{name}_{side}"), expected)
    counts = {name: len(rows) for name, rows in made.faces.items()}
    assert counts == {
        "x0": 2 * layers, "x1": 2 * layers, "y0": 3 * layers, "y1": 3 * layers, "lower": 6, "upper": 6,
    }  # fmt: skip
    assert plate is strip


@pytest.mark.parametrize("cell", CELLS)
def test_faces_meet_at_all_their_nodes_and_middle_nodes_lie_in_the_middle(cell):
    made = strip(6.0, 4.0, 0.6, (3, 2), cell=cell, grading=(3.0, 0.5), layers=2)
    inside = made.connectivity
    assert len(np.unique(inside)) == len(made.points)
    for cell_nodes in inside:
        assert len(set(cell_nodes)) == len(cell_nodes)
    if cell == "hex18":
        x = made.points[inside]
        for a, (b, c) in zip((4, 5, 6, 7), ((0, 1), (1, 2), (2, 3), (3, 0)), strict=True):
            np.testing.assert_allclose(x[:, a], 0.5 * (x[:, b] + x[:, c]), atol=1e-14)
        np.testing.assert_allclose(x[:, 8], x[:, :4].mean(axis=1), atol=1e-14)


@pytest.mark.parametrize("ratio", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("cells", [1, 2, 7])
def test_grading_is_the_ratio_of_last_to_first_interval(cells, ratio):
    lines = graded(3.0, cells, ratio)
    steps = np.diff(lines)
    assert lines[0] == 0.0
    assert lines[-1] == pytest.approx(3.0, rel=1e-15)
    assert len(lines) == cells + 1
    if cells > 1:
        assert steps[-1] / steps[0] == pytest.approx(ratio)
        np.testing.assert_allclose(steps[1:] / steps[:-1], ratio ** (1 / (cells - 1)))


@pytest.mark.parametrize("arguments", [(0.0, 3), (-1.0, 3), (math.nan, 3), (1.0, 0), (1.0, 3, 0.0), (1.0, 3, -2.0)])
def test_impossible_grids_are_refused(arguments):
    with pytest.raises(InvalidValue):
        graded(*arguments)


def test_grid_lines_must_increase_and_cells_be_known():
    with pytest.raises(InvalidValue) as caught:
        grid([0, 1, 1], [0, 1], [0, 1])
    assert caught.value.where == "x"
    with pytest.raises(InvalidValue):
        grid([0, 1], [0], [0, 1])
    with pytest.raises(WrongCellType):
        grid([0, 1], [0, 1], [0, 1], cell="hex20")


def test_cells_without_the_name_of_their_type_are_refused():
    made = strip(2.0, 1.0, 1.0, (2, 1))
    with pytest.raises(WrongCellType, match="ndarray"):
        Mesh(made.points, made.connectivity)


def test_cells_that_stand_twice_are_refused():
    made = strip(6.0, 2.0, 1.0, (3, 2))
    cells = np.vstack([made.connectivity, made.connectivity[4, [4, 5, 6, 7, 0, 1, 2, 3]]])
    with pytest.raises(InvalidValue, match="two cells have the same nodes") as caught:
        Mesh(made.points, {"hex8": cells})
    assert caught.value.where == "cells 4 and 6"


@pytest.mark.parametrize("wrong", [{"sets": {"end": [0.5, 1.9]}}, {"faces": {"top": [[0.7, 0.9]]}}])
def test_sets_of_numbers_that_are_not_whole_are_refused(wrong):
    made = strip(2.0, 1.0, 1.0, (2, 1))
    with pytest.raises(InvalidValue) as caught:
        Mesh(made.points, made.cells, **wrong)
    assert caught.value.where.startswith("set ")


# Selection --------------------------------------------------------------------------------------------------


def test_nodes_are_selected_by_name_predicate_and_ids():
    made = strip(6.0, 4.0, 0.6, (3, 2))
    by_name = made.nodes("x0")
    np.testing.assert_array_equal(made.nodes(lambda x, y, z: x < 1e-9), by_name)
    np.testing.assert_array_equal(made.nodes(by_name[::-1]), by_name)
    np.testing.assert_array_equal(made.nodes([3, 1, 3]), [1, 3])
    np.testing.assert_array_equal(made.nodes(lambda x, y, z: True), np.arange(len(made.points)))
    masked = Mesh(made.points, made.cells, {"end": made.points[:, 0] < 1e-9})
    np.testing.assert_array_equal(masked.nodes("end"), by_name)


@pytest.mark.parametrize(
    "predicate",
    [
        lambda x, y, z: np.flatnonzero(x > 1.0),
        lambda x, y, z: x - 1.0,
        lambda x, y, z: (x > 1.0)[:3],
    ],
)
def test_predicates_return_truth_values(predicate):
    made = strip(6.0, 4.0, 0.6, (3, 2))
    for select in (made.nodes, made.face_set):
        with pytest.raises(InvalidValue, match="returns True or False for each node"):
            select(predicate)
        with pytest.raises(ValueError, match="ambiguous") as caught:
            select(lambda x, y, z: x > 1.0 and y > 1.0)
        assert "(x > 9.99) & (z < 0)" in caught.value.__notes__[0]


@pytest.mark.parametrize("cell", CELLS)
def test_faces_are_selected_by_name_predicate_and_rows(cell):
    made = strip(6.0, 4.0, 0.6, (3, 2), cell=cell)
    for name, predicate in (
        ("lower", lambda x, y, z: z < 0),
        ("upper", lambda x, y, z: z > 0),
        ("x1", lambda x, y, z: x > 6 - 1e-9),
        ("y0", lambda x, y, z: y < 1e-9),
    ):
        rows = made.face_set(predicate)
        assert {tuple(row) for row in rows} == {tuple(row) for row in made.face_set(name)}
    np.testing.assert_array_equal(made.face_set([(2, 1), (0, 0), (2, 1)]), [(2, 1), (0, 0)])
    assert FACES[int(made.face_set("y1")[0, 1])] == "s1"


@pytest.mark.parametrize("cell", CELLS)
def test_faces_between_cells_meet_no_predicate(cell):
    made = strip(6.0, 4.0, 0.6, (3, 2), cell=cell, layers=2)
    for cut in (lambda x, y, z: np.abs(x - 2.0) < 1e-9, lambda x, y, z: np.abs(z) < 1e-9):
        with pytest.raises(EmptySet, match="between two cells"):
            made.face_set(cut)
    outside = {tuple(row) for name in ("lower", "upper", "x0", "x1", "y0", "y1") for row in made.face_set(name)}
    assert {tuple(row) for row in made.face_set(lambda x, y, z: True)} == outside


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(("face", "normal"), [("lower", -1.0), ("upper", 1.0)])
def test_facets_are_ordered_with_the_normal_out_of_the_body(cell, face, normal):
    made = strip(6.0, 4.0, 0.6, (3, 2), cell=cell)
    x = made.points[made.facets(face)]
    assert x.shape[1] == (4 if cell == "hex8" else 9)
    out = np.cross(x[:, 1] - x[:, 0], x[:, 3] - x[:, 0])
    np.testing.assert_allclose(out / np.linalg.norm(out, axis=1)[:, None], [[0, 0, normal]] * len(x), atol=1e-15)
    if cell == "hex18":  # mid-side nodes follow their corners
        for a, (b, c) in zip((4, 5, 6, 7), ((0, 1), (1, 2), (2, 3), (3, 0)), strict=True):
            np.testing.assert_allclose(x[:, a], 0.5 * (x[:, b] + x[:, c]), atol=1e-14)


def test_lateral_faces_are_no_facets():
    with pytest.raises(InvalidValue, match="lower and upper"):
        strip(1, 1, 0.1, (1, 1)).facets("x0")


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("row", [(99, 0), (6, 1), (-1, 0), (0, 9), (0, 6), (0, -1)])
def test_faces_that_do_not_exist_are_refused(cell, row):
    made = strip(6.0, 4.0, 0.6, (3, 2), cell=cell)
    for select in (made.facets, made.face_set):
        with pytest.raises(InvalidValue, match="a pair") as caught:
            select([(0, 0), row])
        assert caught.value.value == list(row)
        assert "6 cells" in caught.value.where
        assert "0 lower, 1 upper" in caught.value.remedy


def test_unknown_sets_are_answered_with_the_known_ones():
    made = strip(6.0, 4.0, 0.6, (3, 2))
    with pytest.raises(UnknownSet) as caught:
        made.nodes("left")
    assert caught.value.value == "left"
    assert all(name in caught.value.remedy for name in ("x0", "x1_upper", "lower"))
    with pytest.raises(UnknownSet) as caught:
        made.facets("bottom")
    assert "lower" in caught.value.remedy
    bare = Mesh(made.points, made.cells)
    with pytest.raises(UnknownSet, match="none"):
        bare.nodes("x0")


def test_empty_sets_are_refused():
    made = strip(6.0, 4.0, 0.6, (3, 2))
    with pytest.raises(EmptySet):
        made.nodes(lambda x, y, z: x > 100)
    with pytest.raises(EmptySet):
        made.nodes([])
    with pytest.raises(EmptySet):
        made.face_set(lambda x, y, z: x > 100)
    with pytest.raises(EmptySet):
        Mesh(made.points, made.cells, sets={"nothing": []}).nodes("nothing")


@pytest.mark.parametrize("ids", [[-1, 2], [0, 999]])
def test_ids_out_of_range_are_refused(ids):
    with pytest.raises(InvalidValue, match="does not exist") as refused:
        strip(6.0, 4.0, 0.6, (3, 2)).nodes(ids)
    assert refused.value.value in (-1, 999)


def test_a_transformed_mesh_keeps_cells_and_sets():
    made = strip(6.0, 4.0, 0.6, (3, 2), cell="hex18")

    def bend(x):
        angle, radius = x[:, 0] / 5.0, 5.0 - x[:, 2]
        return np.stack([radius * np.sin(angle), x[:, 1], 5.0 - radius * np.cos(angle)], axis=1)

    bent = made.transformed(bend)
    np.testing.assert_array_equal(bent.connectivity, made.connectivity)
    assert bent.sets.keys() == made.sets.keys()
    assert bent.faces.keys() == made.faces.keys()
    np.testing.assert_allclose(volumes(bent).sum(), 6 * 4 * 0.6, rtol=1e-3)
    with pytest.raises(WrongNodeOrder):
        made.transformed(lambda x: x * (1, 1, -1))


def test_a_mesh_says_what_it_is():
    assert re.match(r"Mesh\(24 points, 6 hex8, sets: x0, ", repr(strip(6.0, 4.0, 0.6, (3, 2))))


# Refusals ---------------------------------------------------------------------------------------------------


def cells_of(cell, count=2):
    made = strip(2.0 * count, 1.0, 0.3, (count, 1), cell=cell)
    return made.points.copy(), made.connectivity.copy()


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_points_must_be_finite(value):
    points, cells = cells_of("hex8")
    points[5, 1] = value
    with pytest.raises(NotFinite) as caught:
        Mesh(points, {"hex8": cells})
    assert caught.value.where == "node 5"


@pytest.mark.parametrize("size", ["length", "width", "thickness"])
def test_sizes_whose_powers_overflow_are_refused(size):
    sizes = {"length": 10.0, "width": 1.0, "thickness": 0.2} | {size: 1e300}
    with pytest.raises(NotFinite, match="beyond 1e\\+50"):
        strip(**sizes, cells=(2, 1))


def test_points_need_three_columns():
    points, cells = cells_of("hex8")
    with pytest.raises(InvalidValue, match="shape"):
        Mesh(points[:, :2], {"hex8": cells})


@pytest.mark.parametrize("cell", CELLS)
def test_cells_must_be_of_one_known_type_with_the_right_number_of_nodes(cell):
    points, cells = cells_of(cell)
    other = "hex18" if cell == "hex8" else "hex8"
    for wrong in ({}, {"tetra": cells}, {other: cells}, {cell: cells[:, :-1]}, {cell: cells[:0]}, {cell: cells[0]}):
        with pytest.raises(WrongCellType):
            Mesh(points, wrong)
    with pytest.raises(WrongCellType):
        Mesh(points, {cell: cells, "quad": cells})


@pytest.mark.parametrize("shift", [1, -1])
def test_cells_must_name_existing_nodes(shift):
    points, cells = cells_of("hex8")
    with pytest.raises(InvalidValue, match="does not exist"):
        Mesh(points, {"hex8": cells + shift})


@pytest.mark.parametrize("at_once", [1, 2, 1 << 14])
def test_one_inverted_cell_among_good_ones_is_found(at_once, monkeypatch):
    """However many cells are looked at in one go."""
    monkeypatch.setattr(quality, "_AT_ONCE", at_once)
    points, cells = cells_of("hex8", count=3)
    cells[1] = cells[1][[4, 5, 6, 7, 0, 1, 2, 3]]
    with pytest.raises(InvertedElement) as caught:
        Mesh(points, {"hex8": cells})
    assert "cell 1 " in caught.value.where


@pytest.mark.parametrize(
    ("cell", "spoil"),
    [
        ("hex8", lambda x, c: c.__setitem__((1, [0, 1]), c[1, [1, 0]])),
        ("hex8", lambda x, c: x.__setitem__(c[1, 4], x[c[1, 0]] - 0.01)),
        ("hex8", lambda x, c: x.__setitem__(c[1, 1], x[c[1, 0]])),
        ("hex8", lambda x, c: x.__setitem__(slice(None), x * (1, 1, 0))),
        ("hex18", lambda x, c: x.__setitem__(c[1, [4, 13]], x[c[1, [4, 13]]] + (0.7, 0, 0))),
    ],
    ids=["two nodes exchanged", "node through the face", "two nodes in one place", "no thickness", "mid-side node off"],
)
def test_folded_cells_are_found(cell, spoil):
    points, cells = cells_of(cell)
    spoil(points, cells)
    with pytest.raises(FoldedElement):
        Mesh(points, {cell: cells})


#: For each cell a node order met in the wild: new column k holds the old column order[k].
WILD = {
    ("hex8", "upper face first"): [4, 5, 6, 7, 0, 1, 2, 3],
    ("hex8", "faces numbered clockwise"): [0, 3, 2, 1, 4, 7, 6, 5],
    ("hex8", "nodes numbered line by line"): [0, 1, 3, 2, 4, 5, 7, 6],
    ("hex18", "upper face first"): [*range(9, 18), *range(9)],
    ("hex18", "faces numbered clockwise"): [0, 3, 2, 1, 7, 6, 5, 4, 8, 9, 12, 11, 10, 16, 15, 14, 13, 17],
    ("hex18", "nodes numbered line by line"): [0, 4, 1, 7, 8, 5, 3, 6, 2, 9, 13, 10, 16, 17, 14, 12, 15, 11],
}


@pytest.mark.parametrize(("cell", "cause"), WILD, ids=[" ".join(key) for key in WILD])
def test_the_remedy_against_a_wrong_node_order_cures_the_mesh(cell, cause):
    points, cells = cells_of(cell)
    wild = cells[:, WILD[cell, cause]]
    with pytest.raises(WrongNodeOrder) as caught:
        Mesh(points, {cell: wild})
    # A clockwise numbering is a counter-clockwise one with the faces exchanged: volumes cannot tell them apart.
    assert cause in caught.value.cause
    order = [int(number) for number in re.findall(r"\d+", caught.value.remedy.split("[:,")[1])]
    cured = Mesh(points, {cell: wild[:, order]})
    assert (jacobians(cured.points, cured.connectivity) > 0).all()
    np.testing.assert_allclose(volumes(cured), volumes(Mesh(points, {cell: cells})), rtol=1e-13)


@pytest.mark.parametrize("cell", CELLS)
def test_distorted_but_valid_cells_are_accepted(build, cell):
    build.jittered(strip(3.0, 2.0, 0.3, (3, 2), cell=cell), 0.15, normal=0.05)


def test_all_refusals_of_the_mesh_are_mesh_errors_or_invalid_values():
    for error in (InvertedElement, FoldedElement, WrongNodeOrder, WrongCellType, UnknownSet, EmptySet):
        assert issubclass(error, MeshError)


def test_a_mesh_moves_and_follows_a_displacement():
    mesh = strip(2.0, 1.0, 0.5, (2, 1))
    assert np.array_equal(mesh.moved((1.0, 0.0, 0.25)).points, mesh.points + np.array([1.0, 0.0, 0.25]))
    for translation in (1.0, (1.0, 2.0), "z"):
        with pytest.raises(InvalidValue, match="three components"):
            mesh.moved(translation)
    u = np.arange(3.0 * len(mesh.points))
    assert np.array_equal(mesh.displaced(u), mesh.points + u.reshape(-1, 3))
    with pytest.raises(InvalidValue, match="3 numbers, 12 nodes"):
        mesh.displaced(np.array([0.0, 0.0, 1.0]))
    model = Model(mesh, material=SVK(E=1.0, nu=0.0))
    model.u = u
    assert np.array_equal(model.positions, mesh.displaced(u))


def test_grid_lines_that_are_none_are_refused():
    for lines in ("ab", 1.0, [0.0, np.nan]):
        with pytest.raises(InvalidValue, match="grid lines must increase"):
            grid([0.0, 1.0], lines, [0.0, 1.0])
