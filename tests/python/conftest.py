"""Small models, differences and rotations that the tests share; helpers are handed out as fixtures."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import is_dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import umform
from umform import _core, elements
from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.run.checkpoint import Checkpoints
from umform.mesh import FACE_NODES, Mesh, strip
from umform.model import Model
from umform.surfaces import Cylinder


def pytest_configure():
    """Hear Ctrl-C, which a shell without job control lets everything in the background ignore."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node, error):
    """Print the exit status of a worker that has died."""
    if error:
        process = node.gateway._io.popen
        process.wait(10)
        print(f"worker {node.gateway.id} ended with {process.returncode}", file=sys.stderr, flush=True)


@pytest.fixture(scope="session", autouse=True)
def _own_store(tmp_path_factory):
    """Keep results in a folder of the tests, not in that of the user."""
    os.environ["UMFORM_STORE"] = str(tmp_path_factory.mktemp("store"))


#: One law of each kind; the plastic one yields at a strain of 0.001, so that the states of the tests are plastic.
MATERIALS = {
    "svk": mt.SVK(E=210e3, nu=0.3),
    "neo-hooke": mt.NeoHooke(E=210e3, nu=0.3),
    "neo-hooke-power": mt.NeoHookePower(E=210e3, nu=0.3),
    "j2": mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.LinearVoce(160.0, 500.0, 260.0, 20.0)),
}


class PackageCopy:
    """A copy of the package, which tests extend as docs/where-does-it-go.md says; processes of their own import it."""

    def __init__(self, folder):
        self.folder, self.package = folder, folder / "umform"
        shutil.copytree(Path(umform.__file__).parent, self.package, copy_function=os.symlink)

    def write(self, name, text):
        """A new file."""
        file = self.package / name
        assert not file.exists(), name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def put(self, name, before, text):
        """Text before another one, which occurs once in a file."""
        file = self.package / name
        there = file.read_text(encoding="utf-8")
        assert there.count(before) == 1, (name, before)
        file.unlink()  # a link
        file.write_text(there.replace(before, text + before), encoding="utf-8")

    def python(self, *words, given=None):
        """A finished process of Python."""
        return subprocess.run(
            [sys.executable, *map(str, words)],
            env={**os.environ, "PYTHONPATH": str(self.folder)},
            cwd=self.folder,
            input=given,
            capture_output=True,
            text=True,
            check=False,
        )

    def umform(self, *words):
        """A finished command."""
        return self.python("-m", "umform", *words)

    def run(self, program, *words, given=None):
        """What a program prints that imports the copy."""
        imported = f"import umform\nassert umform.__file__.startswith({str(self.folder)!r})\n"
        done = self.python("-c", imported + program, *words, given=given)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout


@pytest.fixture
def stopped(monkeypatch):
    """Every run is stopped in its fourth increment."""
    solve, calls = Newton.solve, []

    def interrupted(self, *arguments, **options):
        calls.append(1)
        if len(calls) == 4:
            raise KeyboardInterrupt
        return solve(self, *arguments, **options)

    monkeypatch.setattr(Newton, "solve", interrupted)


@pytest.fixture
def package_copy(tmp_path):
    return PackageCopy(tmp_path)


class OneElement:
    """One distorted element whose enhanced parameters are solved for at each displacement."""

    def __init__(self, name, material, thickness_points=5, seed=1, rolling=None, **options):
        self.rng = np.random.default_rng(seed)
        self.element = elements.element(name, **options)
        self.nodes = self.element.nodes
        self.X = self.natural_nodes() + self.rng.normal(size=(self.nodes, 3)) * (0.1, 0.1, 0.02)
        self.block = _core.shell_block(
            self.element.technology(),
            self.element.surface_rule,
            *elements.thickness_rule(thickness_points),
            material.law(),
            np.arange(self.nodes, dtype=np.int32)[None],
            self.X.copy(),
            None if rolling is None else np.asarray(rolling, dtype=float),
        )
        equation = np.arange(3 * self.nodes, dtype=np.int32)
        self.pattern = _core.Pattern(equation, [self.block.connectivity], self.block.symmetric)
        self.scatter = self.pattern.scatter(self.block.connectivity)

    def natural_nodes(self):
        """A plate of 2 x 2 x 0.2."""
        face = FACE_NODES[: self.nodes // 2]
        return np.vstack([np.c_[face, np.full(len(face), z)] for z in (-0.1, 0.1)])

    def displacement(self, size=1.0):
        return size * (self.rng.normal(size=(self.nodes, 3)) * (0.03, 0.03, 0.006)).ravel()

    def rotated(self, u, R):
        """The displacement u followed by a rotation and a translation of the element."""
        return ((self.X + u.reshape(-1, 3)) @ R.T + (3.0, -2.0, 1.0) - self.X).ravel()

    def settle(self, u):
        """Solve for the enhanced parameters at u, and leave the trial history of the solution behind."""
        last = np.inf
        for _ in range(40):
            f, values = np.zeros(u.size), np.zeros(self.pattern.indices.size)
            failed, _scale, _why = self.block.evaluate(u, self.scatter, f, values, None, None)
            assert failed == -1
            if self.block.modes == 0 or np.abs(f - last).max() <= 1e-15 * np.abs(f).max():
                return
            last = f
            self.block.recover(np.zeros(u.size))

    def __call__(self, u):
        """Condensed tangent and force of the element at u."""
        self.settle(u)
        return self.block.element(0, u)

    def harden(self, u, steps=4):
        """Go to u in a few converged steps."""
        for step in range(1, steps + 1):
            self.settle(u * step / steps)
            self.block.commit()


def central_difference(function, x, direction, h=1e-6):
    """Derivative of a function along a direction."""
    return (function(x + h * direction) - function(x - h * direction)) / (2 * h)


def relative_error(value, reference):
    """Largest deviation over the largest entry of the reference."""
    return float(np.abs(np.asarray(value) - reference).max() / np.abs(reference).max())


def dense(pattern, values):
    """Matrix of the entries of a pattern, both triangles."""
    n = len(pattern.indptr) - 1
    K = np.zeros((n, n))
    K[np.repeat(np.arange(n), np.diff(pattern.indptr)), pattern.indices] = values
    return K + np.triu(K, 1).T if pattern.symmetric else K


class FullTangent:
    """Force and dense tangent over all degrees of freedom of a contact or pressure block."""

    def __init__(self, block, nodes):
        self.block, self.size = block, 3 * nodes
        equation = np.arange(self.size, dtype=np.int32)
        self.pattern = _core.Pattern(equation, [block.connectivity], False)
        self.scatter = self.pattern.scatter(block.connectivity)

    def __call__(self, u):
        f, values = np.zeros(self.size), np.zeros(self.pattern.indices.size)
        self.block.evaluate(u, self.scatter, f, values, None, None)
        return f, dense(self.pattern, values)

    def force(self, u):
        return self(u)[0]


def jittered(mesh, amount, seed=5, normal=0.0):
    """Move the inner nodes in the plane, lower and upper ones alike, so that the outline stays what it was.

    With ``normal`` all nodes move out of the plane as well.
    """
    points = mesh.points.copy()
    low, high = points.min(axis=0), points.max(axis=0)
    inner = ((points[:, :2] > low[:2] + 1e-9) & (points[:, :2] < high[:2] - 1e-9)).all(axis=1)
    _, column = np.unique(np.round(points[:, :2], 9), axis=0, return_inverse=True)
    rng = np.random.default_rng(seed)
    shift = rng.uniform(-amount, amount, (column.max() + 1, 2))[column.ravel()]
    points[:, :2] += inner[:, None] * shift
    points[:, 2] += normal * rng.uniform(-1, 1, len(points))
    return Mesh(points, mesh.cells, mesh.sets, mesh.faces)


def free_bending(
    cells=(12, 1),
    element="ANS3DEAS",
    points=2,
    length_unit=1.0,
    force_unit=1.0,
    material=None,
    penalty=100.0,
    radius=20.0,
    **options,
):
    """A strip bent freely over a cylinder by its clamped end; units as multiples of mm and N."""
    stress = force_unit / length_unit**2
    L = length_unit
    cell = "hex18" if "9K" in element else "hex8"
    mesh = strip(60 * L, 10 * L, 1 * L, cells, cell=cell)
    material = material or mt.J2(
        kappa=175e3 * stress, mu=80.77e3 * stress, hardening=mt.Linear(160 * stress, 500 * stress)
    )
    model = Model(mesh, element, material=material, **options)
    model.symmetry("x0", normal="x")
    model.symmetry(lambda x, y, z: (x < 1e-9 * L) & (y < 1e-9 * L) & (z < 0), normal="y")
    punch = model.prescribe("x0_lower", "z", "punch")
    tool = Cylinder(centre=(25 * L, 0, -(radius + 0.5) * L), axis="y", radius=radius * L)
    contact = model.contact("lower", tool, penalty=penalty * stress / L, points=points, name="tool")
    return SimpleNamespace(model=model, punch=punch, contact=contact, unit=L, force_unit=force_unit)


def bar(element="ANS3DEAS", material=None, area=0.2, **options):
    """One element of unit length between sliding planes, pulled at x1; its lateral faces are free."""
    cell = "hex18" if "9K" in element else "hex8"
    mesh = strip(1.0, 0.5, area / 0.5, (1, 1), cell=cell)
    model = Model(mesh, element, material=material or MATERIALS["neo-hooke"], **options)
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    return model, model.prescribe("x1", "x", "pull")


def cantilever(load=0.5, cells=(6, 1), element="ANS3DEAS", material=None):
    """An elastic strip clamped at x0 with a dead force at its tip that bends it far."""
    cell = "hex18" if "9K" in element else "hex8"
    model = Model(strip(10.0, 1.0, 0.1, cells, cell=cell), element, material=material or mt.SVK(E=1.2e6, nu=0.0))
    model.fix("x0")
    tip = model.line_load("x1", "lower", (0.0, 0.0, 2.0 * load), "tip")
    return model, tip


def arch(cells=8, element="ANS3DEAS"):
    """Half of a shallow arch of two straight bars, L = 10 each, hinged on its mid-line at the support and at the top.

    The top may rotate by symmetry only; a bar is a plate in plane strain, which makes it a von Mises arch of shells.
    """
    cell = "hex18" if "9K" in element else "hex8"
    mesh = strip(10.0, 1.0, 0.8, (cells, 1), cell=cell)  # so thick that no bar buckles
    x = mesh.points[:, :1] - mesh.points[:, 0].min()
    mesh = mesh.transformed(lambda points: points + np.array([0.0, 0.0, 0.6]) * (1 - x / 10.0))
    model = Model(mesh, element, material=mt.SVK(E=1000.0, nu=0.0))
    model.hinge("x1", "xz")
    model.hinge("x0", "x")  # the symmetry plane, without a moment
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    return model


def loaded_arch(**options):
    """The arch under forces that add up to 1 at the top."""
    model = arch(**options)
    nodes = model.mesh.nodes("x0")
    return model, model.force(nodes, (0.0, 0.0, -1.0 / len(nodes)), "load")


def limit_loads(result):
    """Loads of the limit points that the events tell."""
    found = [re.search(r"limit point.* = (\S+?)(;|$)", event) for event in result.events]
    return [float(match[1]) for match in found if match]


def same_state(a, b):
    """Whether two states are the same to the last bit: snapshots, trees by name, sequences, arrays and numbers."""
    if is_dataclass(a):
        a, b = vars(a) if type(a) is type(b) else None, vars(b) if is_dataclass(b) else b
    if isinstance(a, Mapping):
        return isinstance(b, Mapping) and a.keys() == b.keys() and all(same_state(a[name], b[name]) for name in a)
    if isinstance(a, (list, tuple)):
        return isinstance(b, (list, tuple)) and len(a) == len(b) and all(map(same_state, a, b))
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        one, other = np.asarray(a), np.asarray(b)
        return one.shape == other.shape and one.dtype == other.dtype and one.tobytes() == other.tobytes()
    if isinstance(a, float) and isinstance(b, float):
        return np.float64(a).tobytes() == np.float64(b).tobytes()
    return type(a) is type(b) and a == b


def thickness_vectors(mesh):
    half = mesh.connectivity.shape[1] // 2
    return mesh.points[mesh.connectivity[:, half:]] - mesh.points[mesh.connectivity[:, :half]]


def volume(mesh):
    x, w = _core.gauss(3)
    q = np.stack(np.meshgrid(x, x, x, indexing="ij"), -1).reshape(-1, 3)
    dN = _core.shell_functions(mesh.connectivity.shape[1], q)[1]
    J = np.linalg.det(np.einsum("qia,eak->eqik", dN, mesh.points[mesh.connectivity]))
    return float((J @ np.einsum("i,j,k->ijk", w, w, w).ravel()).sum())


#: A strip that is held at one end and pulled at the other.
PULLED_STRIP = """
[mesh]
generator = "strip"
length = 10.0
width = 2.0
thickness = 1.0
cells = [4, 2]
[material]
law = "SVK"
E = 210e3
nu = 0.3
[[supports]]
kind = "fix"
nodes = "x0"
[controls.pull]
kind = "displacement"
nodes = "x1"
direction = "x"
[[steps]]
kind = "move"
to = { pull = 0.1 }
increments = 2
"""


@pytest.fixture(name="strip", scope="session")
def pulled_strip():
    """A small deck that solves in no time."""
    return PULLED_STRIP


@pytest.fixture
def materials():
    return MATERIALS


@pytest.fixture(scope="session")
def build():
    """Builders of small models and the functions that look at them."""
    return SimpleNamespace(
        one_element=OneElement,
        central_difference=central_difference,
        relative_error=relative_error,
        dense=dense,
        full_tangent=FullTangent,
        jittered=jittered,
        free_bending=free_bending,
        bar=bar,
        cantilever=cantilever,
        arch=arch,
        loaded_arch=loaded_arch,
        limit_loads=limit_loads,
        thickness_vectors=thickness_vectors,
        volume=volume,
    )


@pytest.fixture(name="same_state", scope="session")
def same_state_of_two():
    """Whether two states are the same to the last bit."""
    return same_state


@pytest.fixture
def threads_as_before():
    """Restore the number of threads after a test."""
    before = umform.threads()
    yield
    umform.set_threads(before)


@pytest.fixture
def copies(monkeypatch, tmp_path):
    """Paths of copies of all checkpoints that are written."""
    write, paths = Checkpoints.write, []

    def write_and_copy(self, run):
        write(self, run)
        paths.append(shutil.copy(self.path, tmp_path / f"copy{len(paths)}.h5"))

    monkeypatch.setattr(Checkpoints, "write", write_and_copy)
    return paths


@pytest.fixture
def rng():
    return np.random.default_rng(20)


@pytest.fixture
def rotation():
    """A large rotation about a skew axis."""
    return Rotation.from_rotvec([0.7, -1.9, 1.1]).as_matrix()
