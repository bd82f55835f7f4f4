"""The state of a formed part in files of other programs: read back, in equilibrium, and released by CalculiX."""

from __future__ import annotations

import shutil
import subprocess
from functools import partial

import meshio
import numpy as np
import pytest

import umform as uf
from umform import _core
from umform.errors import FileProblem, InvalidValue
from umform.processes.draw.u_bend import UBend
from umform.report.state_files import PROGRAMS, export_state, read_state
from umform.results.fields import thickness
from umform.results.formed import formed_shells, shell_rule
from umform.results.forming import section
from umform.results.forming.u_bend import u_bend_angles
from umform.sheet_metals import get

ALL = [(to, mesh) for to, program in PROGRAMS.items() for mesh in program.meshes]
STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(160.0, 500.0))
#: Force along a strip of 4 x 1 at which it yields.
YIELDING = 640.0
#: Corners of a hexahedron, in natural coordinates.
CORNERS = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)])
#: Print precision of the formats: digits of their columns.
PRECISION = {"dynain": 2e-8, "radioss": 2e-12, "abaqus": 2e-12, "calculix": 2e-12}


class Bent:
    """A strip that a force across its end has bent beyond yield; no tools."""

    def __init__(self, element, cell):
        cells = {"hex8": (16, 2), "hex18": (16, 1)}[cell]
        self.model = uf.Model(uf.mesh.strip(20.0, 4.0, 1.0, cells, cell=cell), element, material=STEEL)
        self.model.fix("x0")
        nodes = len(self.model.mesh.nodes("x1"))
        self.force = 11.0
        load = self.model.force("x1", (0.0, 0.0, -1.0 / nodes), "load")
        self.result = uf.solve(self.model, uf.Move(load, self.force, steps=8), progress=False)
        self.x = self.model.positions
        self.tip = self.x[self.model.mesh.nodes("x1")].mean(axis=0)


@pytest.fixture(scope="module", params=[("BEND8", "hex8"), ("BEND18", "hex18")], ids=lambda pair: pair[0])
def bent(request):
    return Bent(*request.param)


@pytest.fixture(scope="module")
def bent8():
    return Bent("BEND8", "hex8")


def matrix(components):
    return components[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]


def nodal_forces(state):
    """Internal forces (cells, 8, 3) of trilinear solids with one or eight points, from a state alone."""
    each = 1 if state.stress.shape[1] == 1 else 2
    g, w = _core.gauss(each)
    t, s, r = (axis.ravel() for axis in np.meshgrid(g, g, g, indexing="ij"))
    points = np.stack([r, s, t], axis=1)
    one = 1.0 + points[:, None] * CORNERS
    slope = np.stack([CORNERS[:, k] * one[..., (k + 1) % 3] * one[..., (k + 2) % 3] for k in range(3)], axis=-1) / 8.0
    jacobian = np.einsum("qki,eka->eqia", slope, state.points[state.cells])
    gradient = np.einsum("eqai,qki->eqka", np.linalg.inv(jacobian), slope)
    volume = np.linalg.det(jacobian) * np.array(w)[0] ** 3
    return np.einsum("eqka,eqab,eq->ekb", gradient, matrix(state.stress), volume)


@pytest.mark.parametrize(("to", "mesh"), ALL)
def test_a_file_is_read_back_within_its_digits(bent, tmp_path, to, mesh):
    path = tmp_path / "part"
    written = export_state(bent.result, path, to, mesh=mesh, units="mm, N, MPa")
    read = read_state(path, to)
    assert "mm, N, MPa" in path.read_text().split("\n*NODE")[0].split("\n/NODE")[0]
    assert written.shells == read.shells == (mesh == "shells")
    for name in ("cells", "parts"):
        np.testing.assert_array_equal(getattr(read, name), getattr(written, name))
    names = ["points", "stress", "plastic", *(["thickness", "heights"] if mesh == "shells" else [])]
    names += ["strain"] if (to, mesh) == ("dynain", "shells") else []
    names += ["history"] if to == "abaqus" else []
    if to == "calculix":
        names.remove("plastic")  # it has no keyword for it
    for name in names:
        here, there = getattr(written, name), getattr(read, name)
        if (to, name) == ("radioss", "thickness"):
            here = np.repeat(here.mean(axis=1, keepdims=True), 4, axis=1)  # one for each shell
        np.testing.assert_allclose(there, here, rtol=PRECISION[to], atol=1e-12)
    assert written.plastic.max() > 0.004


def test_stresses_of_solids_carry_the_load_through_each_section(bent, tmp_path):
    export_state(bent.result, tmp_path / "part.inp", "calculix")
    state = read_state(tmp_path / "part.inp", "calculix")
    forces, mesh = nodal_forces(state), bent.model.mesh
    stacks = len(state.cells) // len(mesh.connectivity)
    along = np.repeat(mesh.points[mesh.connectivity].mean(axis=1)[:, 0], stacks)
    for cut in (2.5, 5.0, 10.0, 15.0):
        left = along < cut
        total = np.zeros_like(state.points)
        np.add.at(total, state.cells[left], forces[left])
        on = np.intersect1d(state.cells[left], state.cells[~left])
        through = total[on].sum(axis=0)
        np.testing.assert_allclose(through, [0.0, 0.0, -bent.force], atol=0.002 * YIELDING)
        arm = bent.tip[0] - state.points[on].mean(axis=0)[0]
        turning = np.cross(state.points[on] - bent.tip, total[on]).sum(axis=0)
        np.testing.assert_allclose(turning, 0.0, atol=0.01 * bent.force * arm)


def sections(state, rule):
    """For points of shells or one-point solids: direction along the strip, force along it, height, place (m, q)."""
    corners = state.points[state.cells]
    if not state.shells:
        half = 0.5 * (corners[:, :4] + corners[:, 4:])
        rise = np.einsum("ek,ek->e", corners[:, 4:].mean(axis=1) - corners[:, :4].mean(axis=1), normal_of(half))
        heights, share = np.zeros((len(rise), 1)), rise[:, None]
    else:
        half, h = corners, state.thickness.mean(axis=1)
        _, weights, moments = shell_rule(len(state.heights), rule)
        heights, share = 0.5 * h[:, None] * moments / weights, 0.5 * h[:, None] * weights
    way = 0.5 * (half[:, 1] + half[:, 2] - half[:, 0] - half[:, 3])
    width = np.linalg.norm(0.5 * (half[:, 3] + half[:, 2] - half[:, 0] - half[:, 1]), axis=1)
    e = way / np.linalg.norm(way, axis=1, keepdims=True)
    stress = np.einsum("ei,eqij,ej->eq", e, matrix(state.stress), e)
    place = half.mean(axis=1)[:, None] + heights[..., None] * normal_of(half)[:, None]
    return e, stress * share * width[:, None], place


def normal_of(quads):
    normal = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("to", "mesh", "points"),
    [
        ("dynain", "shells", 5),
        ("dynain", "shells", 9),
        ("dynain", "solids", 2),
        ("radioss", "shells", 9),
        ("radioss", "solids", 2),
        ("abaqus", "solids", 2),
    ],
)
def test_the_sections_of_each_cell_have_force_and_moment_of_the_load(bent, tmp_path, to, mesh, points):
    export_state(bent.result, tmp_path / "part", to, mesh=mesh, points=points)
    state, blank = read_state(tmp_path / "part", to), bent.model.mesh
    e, force, place = sections(state, PROGRAMS[to].rule)
    each = len(state.cells) // len(blank.connectivity)
    rows = np.repeat(np.round(blank.points[blank.connectivity].mean(axis=1)[:, 0], 6), each)
    for row in np.unique(rows)[:-1]:
        some = rows == row
        parts = (4 if blank.cell == "hex18" else 1) // (2 if blank.cell == "hex18" else 1)
        vectors = (force[some][..., None] * e[some][:, None]).reshape(-1, 3) / parts
        x = place[some].reshape(-1, 3)
        moment = np.cross(x - x.mean(axis=0), vectors).sum(axis=0)[1]
        # Of the sections at different places of a cell, each against the middle of the cell.
        arm = bent.tip[0] - x.mean(axis=0)[0]
        assert abs(moment) == pytest.approx(bent.force * arm, rel=0.01)
        along = vectors.sum(axis=0) @ e[some].mean(axis=0)
        assert along == pytest.approx(bent.force * abs(e[some].mean(axis=0)[2]), abs=0.01 * YIELDING)


def test_evenly_spaced_points_have_the_weights_of_openradioss():
    """The printed ones of its theory manual, for heights in thicknesses: 4 and 6 points."""
    for points, forces, moments in (
        (4, [0.1667, 0.3333], [0.0648, 0.0556]),
        (6, [0.1, 0.2, 0.2], [0.0433, 0.06, 0.02]),
    ):
        t, w, m = shell_rule(points, "even")
        np.testing.assert_allclose(t, np.linspace(-1.0, 1.0, points))
        np.testing.assert_allclose(w[::-1][: len(forces)] / 2.0, forces, atol=1e-4)
        np.testing.assert_allclose(m[::-1][: len(moments)] / 4.0, moments, atol=1e-4)


def test_shells_lie_on_the_middle_and_have_the_thickness_of_the_sheet(bent):
    state = formed_shells(bent.model, 7)
    lower, upper = np.split(bent.model.mesh.connectivity, 2, axis=1)
    middle = 0.5 * (bent.x[lower] + bent.x[upper])
    assert {tuple(np.round(x, 9)) for x in middle.reshape(-1, 3)} == {tuple(np.round(x, 9)) for x in state.points}
    mean = thickness(bent.model).mean()
    assert state.thickness.mean() == pytest.approx(mean, rel=2e-3)
    assert len(state.cells) == len(lower) * (4 if lower.shape[1] == 9 else 1)


def test_strains_are_logarithmic_and_in_global_axes():
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 0.5, (2, 1)), "ANS3DEAS", material=STEEL)
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    model.hinge("x0", "z")
    pull = model.prescribe("x1", "x", "pull")
    uf.solve(model, uf.Move(pull, 0.8, steps=8), progress=False)
    state = formed_shells(model, 3)
    np.testing.assert_allclose(state.strain[..., 0], np.log(1.2), rtol=1e-3)
    np.testing.assert_allclose(state.strain[..., :3].sum(axis=-1), 0.0, atol=2e-3)  # of a plastic metal
    np.testing.assert_allclose(np.log(state.thickness / 0.5).mean(), state.strain[..., 2].mean(), rtol=2e-2)


@pytest.fixture(scope="module", params=[("BEND8", "hex8", 24), ("BEND18", "hex18", 12)], ids=lambda one: one[0])
def half(request):
    """Half of a strip that is bent around a cylinder, in plane strain: loaded; the punch releases it."""
    element, cell, cells = request.param
    model = uf.Model(uf.mesh.strip(30.0, 0.5, 1.0, (cells, 1), cell=cell), element, material=STEEL)
    model.symmetry("x0", normal="x")
    model.symmetry(lambda x, y, z: y > -1.0, normal="y")
    model.contact("lower", uf.Cylinder((12.0, 0.0, -3.5), "y", 3.0), name="roll", penalty=2000.0)
    punch = model.prescribe("x0_lower", "z", "punch")
    uf.solve(model, uf.Move(punch, -5.0, steps=16), progress=False)
    return model, punch


def test_a_mirrored_part_is_whole_and_balanced(half, tmp_path):
    model, _ = half
    one = export_state(model, tmp_path / "half.inp", "calculix")
    two = export_state(model, tmp_path / "whole.inp", "calculix", mirror=True)
    shared = np.sum(np.abs(one.points[:, 0]) < 1e-9)
    assert len(two.points) == 2 * len(one.points) - shared
    assert len(two.cells) == 2 * len(one.cells)
    forces = nodal_forces(two)  # of positive volumes only: the inverse of the Jacobian is finite
    total = np.zeros_like(two.points)
    np.add.at(total, two.cells, forces)
    own = np.zeros_like(one.points)
    np.add.at(own, one.cells, nodal_forces(one))
    np.testing.assert_array_equal(two.points[: len(one.points)], one.points)
    inside = np.flatnonzero(np.abs(two.points[:, 0]) < 1e-9)
    assert np.abs(own[inside, 0]).max() > 1.0
    np.testing.assert_allclose(total[inside, 0], 0.0, atol=1e-9)
    np.testing.assert_allclose(total[inside, 2], 2.0 * own[inside, 2], atol=1e-9)
    shells = export_state(model, tmp_path / "whole.k", mirror=True)
    corners = shells.points[shells.cells]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    assert (normal[:, 2] > 0.0).all()
    np.testing.assert_allclose(np.ptp(shells.points[:, 0]), 2.0 * shells.points[:, 0].max())


def test_bodies_are_parts():
    mesh = uf.mesh.strip(10.0, 1.0, 0.2, (8, 1))
    bodies = [
        uf.Body(material=uf.SVK(E=70e3, nu=0.3), cells=lambda x, y, z: x < 5.0, name="soft"),
        uf.Body(material=STEEL, cells=lambda x, y, z: x > 5.0, name="stiff"),
    ]
    model = uf.Model(mesh, bodies=bodies)
    model.fix("x0")
    uf.solve(model, uf.Move(model.prescribe("x1_lower", "z", "tip"), -3.0, steps=4), progress=False)
    state = formed_shells(model, 5)
    np.testing.assert_array_equal(state.parts, np.where(mesh.points[mesh.connectivity].mean(axis=1)[:, 0] < 5.0, 1, 2))
    assert not state.plastic[state.parts == 1].any()


def test_an_elastic_part_has_no_hardening_and_no_state_variables(tmp_path):
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (4, 1)), material=uf.SVK(E=70e3, nu=0.3))
    model.fix("x0")
    result = uf.solve(model, uf.Move(model.prescribe("x1_lower", "z", "tip"), -0.5, steps=1), progress=False)
    uf.export_state(result, tmp_path / "part.inp", "abaqus")
    text = (tmp_path / "part.inp").read_text()
    assert "TYPE=STRESS" in text and "HARDENING" not in text and "SOLUTION" not in text


def test_state_variables_are_named_in_their_order(bent8, tmp_path):
    state = export_state(bent8.result, tmp_path / "part.inp", "abaqus")
    assert "** state variables in their order: Cp_inv (6), eqps (1)" in (tmp_path / "part.inp").read_text()
    assert state.history.shape == (len(state.cells), 7)
    np.testing.assert_allclose(state.history[:, 6], state.plastic[:, 0], atol=2e-3)


def test_another_reader_finds_the_mesh(bent8, tmp_path):
    state = export_state(bent8.result, tmp_path / "part.inp", "abaqus", layers=2)
    mesh = meshio.read(tmp_path / "part.inp")
    np.testing.assert_allclose(mesh.points, state.points, rtol=1e-11)
    np.testing.assert_array_equal(mesh.cells[0].data, state.cells)


def refused(tmp_path, *arguments, **options):
    with pytest.raises(InvalidValue) as caught:
        export_state(arguments[0], tmp_path / "part", *arguments[1:], **options)
    assert not list(tmp_path.iterdir())
    return str(caught.value)


def test_what_cannot_be_written_is_refused_with_one_message(bent8, tmp_path):
    virgin = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (4, 1)), material=STEEL)
    virgin.fix("x0")
    assert "no stresses" in refused(tmp_path, virgin)
    assert "unknown program" in refused(tmp_path, bent8.model, "nastran")
    assert "no such mesh" in refused(tmp_path, bent8.model, "abaqus", mesh="shells")
    assert "2 to 20 points" in refused(tmp_path, bent8.model, points=1)
    assert "1 to 40 layers" in refused(tmp_path, bent8.model, "abaqus", layers=0)
    assert "no plane of symmetry" in refused(tmp_path, bent8.model, mirror=True)


def test_stacked_cells_are_solids_only(tmp_path):
    one = uf.mesh.strip(8.0, 1.0, 0.5, (4, 1))
    lower = np.unique(one.connectivity[:, :4])
    number = np.arange(len(one.points))
    number[lower] = len(one.points) + np.arange(len(lower))
    below = one.points[lower] - [0.0, 0.0, 0.5]
    second = np.concatenate([number[one.connectivity[:, :4]], one.connectivity[:, :4]], axis=1)
    mesh = uf.Mesh(np.concatenate([one.points, below]), {"hex8": np.concatenate([one.connectivity, second])})
    model = uf.Model(mesh, material=STEEL)
    model.fix(lambda x, y, z: x < 1e-9)
    tip = model.prescribe(lambda x, y, z: x > 8.0 - 1e-9, "z", "tip")
    uf.solve(model, uf.Move(tip, -0.5, steps=2), progress=False)
    assert "stacked" in refused(tmp_path, model)
    state = export_state(model, tmp_path / "part.k", mesh="solids", layers=2)
    assert len(state.cells) == 16 and len(state.points) == 10 * 5


def test_a_file_that_is_missing_is_one_message(tmp_path):
    with pytest.raises(FileProblem, match="cannot be read"):
        read_state(tmp_path / "none.k")


def angle(mesh, x):
    """Slope of the free end in degrees."""
    centres = x[mesh.connectivity].mean(axis=1)
    far = centres[mesh.points[mesh.connectivity].mean(axis=1)[:, 0] > 20.0]
    way = far[-1] - far[0]
    return np.degrees(np.arctan2(way[2], way[0]))


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_finds_the_same_springback(half, tmp_path):
    model, punch = half
    mesh, state = model.mesh, export_state(model, tmp_path / "part.inp", "calculix")
    loaded = mesh.displaced(model.u)
    inside = np.flatnonzero(np.abs(state.points[:, 0]) < 1e-9) + 1
    lowest = inside[state.points[inside - 1, 2] < state.points[inside - 1, 2].min() + 1e-6]
    lines = ["*INCLUDE, INPUT=part.inp", "*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0.3"]
    lines += ["*SOLID SECTION, ELSET=PART1, MATERIAL=STEEL", "*BOUNDARY", "SHEET, 2, 2"]
    lines += [f"{node}, 1, 1" for node in inside] + [f"{node}, 3, 3" for node in lowest]
    lines += ["*STEP, NLGEOM", "*STATIC", "1., 1.", "*NODE PRINT, NSET=SHEET", "U", "*END STEP"]
    (tmp_path / "job.inp").write_text("\n".join(lines) + "\n")
    subprocess.run(["ccx", "job"], cwd=tmp_path, check=True, capture_output=True, timeout=120)
    rows = [line.split() for line in (tmp_path / "job.dat").read_text().splitlines()]
    there = np.array([[float(word) for word in row] for row in rows if len(row) == 4 and row[0].isdigit()])
    released = state.points.copy()
    released[there[:, 0].astype(int) - 1] += there[:, 1:]
    number = [int(np.argmin(np.linalg.norm(state.points - x, axis=1))) for x in loaded]
    uf.solve(model, uf.Release(punch), progress=False)
    ours = angle(mesh, mesh.displaced(model.u)) - angle(mesh, loaded)
    theirs = angle(mesh, released[number]) - angle(mesh, loaded)
    assert ours < -0.5
    assert theirs == pytest.approx(ours, rel=0.01)


def _rows(path):
    words = [line.split() for line in path.read_text().splitlines()]
    return np.array([[float(word) for word in row] for row in words if len(row) == 4 and row[0].isdigit()])


@pytest.mark.long
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_finds_the_springback_of_a_drawn_section(tmp_path):
    """Its nodal forces hold the part at first, and fall to zero in increments: at once Newton's method diverges."""
    sizes = {"thickness": 0.78, "punch_edge": 5.0, "die_edge": 5.0, "length": 300.0, "width": 35.0, "punch_width": 50.0}
    case = UBend(**sizes, holder_force=2450.0, element="BEND8", contact_points=3, turn=10.0, material=get("DC04").law)
    model, press = case.build()
    uf.solve(model, press.closing, options=case.newton, progress=False)
    mesh, loaded = model.mesh, model.u.reshape(-1, 3).copy()
    state = export_state(model, tmp_path / "part.inp", "calculix")
    middle = np.flatnonzero(np.abs(state.points[:, 0]) < 1e-9) + 1
    lowest = middle[state.points[middle - 1, 2] < state.points[middle - 1, 2].min() + 1e-6]
    head = ["*INCLUDE, INPUT=part.inp", "*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0.3"]
    head += ["*SOLID SECTION, ELSET=PART1, MATERIAL=STEEL", "*BOUNDARY"]

    def run(job, lines):
        (tmp_path / f"{job}.inp").write_text("\n".join([*head, *lines, "*END STEP"]) + "\n")
        subprocess.run(["ccx", job], cwd=tmp_path, check=True, capture_output=True, timeout=120)
        return _rows(tmp_path / f"{job}.dat")[-len(state.points) :]

    step = ["*STEP, NLGEOM, INC=1000", "*STATIC"]
    forces = run("held", ["SHEET, 1, 3", *step, "1., 1.", "*NODE PRINT, NSET=SHEET", "RF"])
    lines = ["SHEET, 2, 2", *(f"{node}, 1, 1" for node in middle), *(f"{node}, 3, 3" for node in lowest)]
    for start, factor in (("1., 1.", 1.0), ("0.05, 1.", 0.0)):
        lines += ["*END STEP"] * (factor == 0.0) + [*step, start, "*CLOAD"]
        lines += [f"{row[0]:.0f}, {k}, {factor * row[k]:.12g}" for row in forces for k in (1, 3)]
    there = run("free", [*lines, "*NODE PRINT, NSET=SHEET, FREQUENCY=1000", "U"])
    released = state.points.copy()
    released[there[:, 0].astype(int) - 1] += there[:, 1:]
    number = [int(np.argmin(np.linalg.norm(state.points - x, axis=1))) for x in mesh.points + loaded]
    uf.solve(model, press.opening, options=case.newton, progress=False)
    shapes = loaded, model.u.reshape(-1, 3), released[number] - mesh.points
    first, ours, theirs = ((one.theta1, one.theta2) for one in map(partial(_angles, mesh), shapes))
    changes = np.subtract(ours, first)
    assert changes[0] > 8.0 and changes[1] < -8.0
    assert np.subtract(theirs, first) == pytest.approx(changes, rel=0.03)


def _angles(mesh, u):
    line = section(mesh, u).middle[:, [0, 2]]
    return u_bend_angles(line - line[0], flange=max(len(line) // 12, 2))
