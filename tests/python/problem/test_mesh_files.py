"""Meshes of other programs in decks: hexahedra numbered in any way, surfaces that are thickened."""

import meshio
import numpy as np
import pytest

import umform as uf
from umform.problem import Problem


def with_mesh(strip, keys):
    """The small deck with a mesh from a file; loads and supports on the plane x = 0."""
    first, last = "{ max = [0.0, inf, inf] }", "{ min = [10.0, -inf, -inf] }"
    head = '[mesh]\nfile = "sheet.vtu"\n' + "".join(f"{key} = {value}\n" for key, value in keys.items())
    text = head + strip[strip.index("[material]") :]
    return text.replace('"x0"', first).replace('"x1"', last)


@pytest.fixture
def hexahedra(tmp_path):
    """A sheet that is thin along y, whose cells are numbered along x first."""
    x, y, z = np.meshgrid(np.linspace(0, 10, 5), [0.0, 0.5], [0.0, 1.0, 2.0], indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    at = np.arange(len(points)).reshape(x.shape)
    faces = ((0, 0), (1, 0), (1, 1), (0, 1))
    cells = [[at[i + e, j, k + m] for e in (0, 1) for j, m in faces] for i in range(4) for k in range(2)]
    meshio.write(tmp_path / "sheet.vtu", meshio.Mesh(points, [("hexahedron", np.array(cells))]))
    return tmp_path


@pytest.mark.parametrize("through", ['"thinnest"', '"-y"', "[0.0, -1.0, 0.0]"])
def test_hexahedra_are_turned(through, hexahedra, strip):
    mesh = Problem.read(with_mesh(strip, {"through": through}), folder=hexahedra).build().model.mesh
    same = uf.mesh.read(hexahedra / "sheet.vtu", through="thinnest" if "thin" in through else "-y")
    assert np.array_equal(mesh.connectivity, same.connectivity)
    upper = mesh.points[mesh.nodes("upper")][:, 1]
    assert np.allclose(upper, 0.5 if "thin" in through else 0.0)


def test_hexahedra_without_a_direction_lie_as_they_are(hexahedra, strip):
    mesh = Problem.read(with_mesh(strip, {}), folder=hexahedra).build().model.mesh
    assert np.allclose(mesh.points[mesh.nodes("upper")][:, 0], 10.0)


def other_mesh(folder, kind, columns):
    """The same file with other columns of its cells, or other cells of them."""
    read = meshio.read(folder / "sheet.vtu")
    meshio.write(folder / "sheet.vtu", meshio.Mesh(read.points, [(kind, read.cells[0].data[:, columns])]))


@pytest.mark.parametrize(
    ("kind", "columns", "what", "remedy"),
    [
        ("quad", [0, 1, 2, 3], "hexahedra", "the key thickness in [mesh] thickens"),
        ("tetra", [0, 1, 2, 4], "hexahedra", "thicken them: the key thickness in [mesh]"),
        ("hexahedron", [0, 1, 3, 2, 4, 5, 7, 6], "in another order", "through = 'thinnest'"),
        ("hexahedron", [4, 5, 6, 7, 0, 1, 2, 3], "another order", "through = 'thinnest'"),
    ],
)
def test_remedies_are_keys_of_the_deck(kind, columns, what, remedy, hexahedra, strip, errors):
    other_mesh(hexahedra, kind, columns)
    told = errors(with_mesh(strip, {}), folder=hexahedra)[0]
    assert what in told.what
    assert remedy in told.remedy
    assert "umform" not in told.remedy
    with pytest.raises(uf.UmformError) as python:
        uf.mesh.read(hexahedra / "sheet.vtu")
    assert ("read_shell" in python.value.remedy) == ("[mesh]" in remedy)


def test_the_proposed_key_helps(hexahedra, strip):
    other_mesh(hexahedra, "hexahedron", [4, 5, 6, 7, 0, 1, 2, 3])
    Problem.read(with_mesh(strip, {"through": '"thinnest"'}), folder=hexahedra).build()


def test_a_body_that_is_no_sheet_is_told_with_the_key(tmp_path, strip, errors):
    """A bar that is bent to a ring and turned by half: its thickness has one side only."""
    a = np.arange(24)[:, None] * np.pi / 12
    e1 = np.column_stack([np.cos(a / 2) * np.cos(a), np.cos(a / 2) * np.sin(a), np.sin(a / 2)])
    e2 = np.column_stack([-np.sin(a / 2) * np.cos(a), -np.sin(a / 2) * np.sin(a), np.cos(a / 2)])
    centre = 5.0 * np.column_stack([np.cos(a), np.sin(a), 0.0 * a])
    points = np.stack([centre + s * e1 + t * e2 for s, t in ((-1, -0.1), (1, -0.1), (1, 0.1), (-1, 0.1))], axis=1)
    node = np.arange(96).reshape(24, 4)
    cells = np.hstack([node, np.vstack([node[1:], node[:1, [2, 3, 0, 1]]])])
    meshio.write(tmp_path / "sheet.vtu", meshio.Mesh(points.reshape(-1, 3), [("hexahedron", cells)]))
    told = errors(with_mesh(strip, {"through": '"thinnest"'}), folder=tmp_path)[0]
    assert "Moebius" in told.cause
    assert told.remedy.endswith("thicken a surface (the key thickness in [mesh])")


@pytest.mark.parametrize(
    ("keys", "low"), [({}, -0.3), ({"surface": '"lower"'}, 0.0), ({"surface": '"upper"', "kink": 30.0}, -0.6)]
)
def test_surfaces_are_thickened_and_solve(keys, low, tmp_path, strip):
    x, y = np.meshgrid(np.linspace(0, 10, 5), [0.0, 1.0, 2.0], indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), 0.0 * x.ravel()])
    quads = [[3 * i + k, 3 * i + 3 + k, 3 * i + 4 + k, 3 * i + 1 + k] for i in range(4) for k in range(2)]
    meshio.write(tmp_path / "sheet.vtu", meshio.Mesh(points, [("quad", np.array(quads))]))
    problem = Problem.read(with_mesh(strip, {"thickness": 0.6} | keys), folder=tmp_path).build()
    z = problem.model.mesh.points[:, 2]
    assert np.allclose([z.min(), z.max()], [low, low + 0.6])
    result = problem.solve(progress=False)
    model = uf.Model(uf.mesh.strip(10.0, 2.0, 0.6, (4, 2)), material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    same = uf.solve(model, uf.Move(model.prescribe("x1", "x", "pull"), 0.1, steps=2), progress=False)
    assert np.allclose(result["pull_force"], same["pull_force"], rtol=1e-9)


@pytest.mark.parametrize(
    ("keys", "where", "what"),
    [
        ({"through": 3}, "line 3, mesh.through", "it should be thinnest"),
        ({"through": '"sideways"'}, "line 3, mesh.through", "unknown direction"),
        ({"through": '"x"', "thickness": 1.0}, "line 3, mesh.through", "unknown here"),
        ({"kink": 30.0}, "line 1, mesh", "thickness is missing"),
        ({"thickness": -1.0}, "line 3, mesh.thickness", "greater than 0"),
        ({"thickness": 1.0}, "line 1, mesh", "quadrilaterals"),
    ],
)
def test_mistakes_are_told_with_their_key(keys, where, what, hexahedra, strip, errors):
    told = errors(with_mesh(strip, keys), folder=hexahedra)[0]
    assert where in told.where
    assert what in told.what
    assert told.cause
    assert told.remedy
