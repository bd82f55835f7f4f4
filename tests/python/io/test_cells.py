import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkGenericCell, vtkLagrangeHexahedron

from umform.errors import InvalidValue, NotFinite, WrongCellType
from umform.io.cells import CELL_TYPES, LAGRANGE_TYPES, cell_type, from_vtk, to_vtk


@pytest.mark.parametrize("kind", [*CELL_TYPES.values(), *LAGRANGE_TYPES.values()], ids=lambda kind: str(kind.vtk_type))
def test_nodes_lie_where_vtk_has_them(kind, nodes):
    X = nodes[kind.name]
    grid = to_vtk(kind, X, [range(kind.nodes)])
    cell = vtkGenericCell.InstantiateCell(kind.vtk_type)
    if kind.degrees:
        cell.SetOrder(*kind.degrees)
        cell.GetPoints().SetNumberOfPoints(kind.nodes)
        cell.GetPointIds().SetNumberOfIds(kind.nodes)
    expected = np.reshape([cell.GetParametricCoords()[i] for i in range(3 * cell.GetNumberOfPoints())], (-1, 3))
    assert sorted(kind.vtk_nodes) == list(range(cell.GetNumberOfPoints()))
    np.testing.assert_allclose((grid.points[grid.connectivity[0]] + 1) / 2, expected)


def test_nodes_of_lagrange_cells_have_the_numbers_of_vtk(nodes):
    kind = cell_type("hex18", lagrange=True)
    cell = vtkLagrangeHexahedron()
    cell.SetOrder(*kind.degrees)
    ijk = ((nodes["hex18"] + 1) / 2 * kind.degrees).round().astype(int).tolist()
    assert [kind.vtk_nodes[cell.PointIndexFromIJK(*node)] for node in ijk] == list(range(18))


def test_lagrange_is_the_same_for_cells_without_such_a_twin():
    assert cell_type("hex8", lagrange=True) is cell_type("hex8")


@pytest.mark.parametrize("lagrange", [False, True])
def test_there_and_back(sheet, lagrange):
    kind = cell_type(sheet.cells, lagrange=lagrange)
    grid = to_vtk(kind, sheet.points, sheet.connectivity)
    np.testing.assert_array_equal(grid.points[: len(sheet.points)], sheet.points)
    np.testing.assert_array_equal(from_vtk(kind, grid.points, grid.connectivity), sheet.connectivity)


def test_neighbours_share_the_points_of_the_middle_layer(quadratic_sheet):
    grid = to_vtk(cell_type("hex18"), quadratic_sheet.points, quadratic_sheet.connectivity)
    assert len(grid.pairs) == 2 * 7 * 5  # two layers of cells, each with one middle layer


def test_curved_thickness_is_refused(quadratic_sheet):
    kind = cell_type("hex18")
    grid = to_vtk(kind, quadratic_sheet.points, quadratic_sheet.connectivity)
    grid.points[grid.connectivity[4, 26]] += 0.01
    with pytest.raises(WrongCellType, match="curved through the thickness") as info:
        from_vtk(kind, grid.points, grid.connectivity)
    assert info.value.where == "cell 4"


def test_neighbours_with_different_thickness_directions_are_refused(nodes):
    size = (5, 3, 3)
    X = np.stack(np.unravel_index(np.arange(45), size), axis=1).astype(float)
    rst = (nodes["hex18"] + 1).round().astype(int)
    rst = np.vstack([rst, (rst[:9] + rst[9:]) // 2])[list(cell_type("hex18").vtk_nodes)]
    upright = np.ravel_multi_index(tuple(rst.T), size)
    lying = np.ravel_multi_index(tuple((rst[:, [2, 0, 1]] + (2, 0, 0)).T), size)
    with pytest.raises(WrongCellType, match="do not agree"):
        from_vtk(cell_type("hex18"), X, np.array([upright, lying]))


def test_wrong_input_is_refused(nodes):
    kind, X = cell_type("hex8"), nodes["hex8"]
    with pytest.raises(WrongCellType, match="hex18, hex8"):
        cell_type("tet4")
    with pytest.raises(InvalidValue, match="shape"):
        to_vtk(kind, X[:, :2], [range(8)])
    with pytest.raises(InvalidValue, match="shape"):
        to_vtk(kind, X, [range(7)])
    with pytest.raises(InvalidValue, match="do not exist"):
        to_vtk(kind, X, [range(1, 9)])
    with pytest.raises(NotFinite, match="point 2"):
        to_vtk(kind, np.where(np.arange(24).reshape(8, 3) == 7, np.nan, X), [range(8)])
