"""What every model pays: an ordinary model loads nothing that it does not need, and names cost nothing."""

import subprocess
import sys
import tracemalloc

import umform as uf

_ORDINARY = """
import sys
import umform as uf
mesh = uf.mesh.strip(length=4, width=1, thickness=0.5, cells=(4, 1))
model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=1.0, nu=0.3))
model.fix("x0")
model.hinge("x1")
model.force("x1", (0, 0, 1.0))
model.contact("lower", uf.Plane(point=(0, 0, -1), normal=(0, 0, 1)), penalty=1.0)
model.evaluate(model.u)
print(*sys.modules)
"""


def test_supports_along_the_axes_load_no_scipy():
    run = subprocess.run([sys.executable, "-c", _ORDINARY], capture_output=True, text=True, check=True)
    assert "umform.model.supports.constraints" in run.stdout.split()
    assert not {"scipy", "matplotlib", "h5py"} & set(run.stdout.split())


def test_a_model_loads_the_tools_laws_and_solvers_in_use():
    run = subprocess.run([sys.executable, "-c", _ORDINARY], capture_output=True, text=True, check=True)
    loaded = set(run.stdout.split())
    assert {"umform.surfaces.simple", "umform.materials.elastic", "umform.solvers.multifrontal"} <= loaded
    tools = {f"umform.surfaces.{name}" for name in ("cad", "triangulated", "press_brake", "led_around", "sizes")}
    laws = {f"umform.materials.{name}" for name in ("metal", "umat", "compiled", "yield_functions")}
    solvers = {f"umform.solvers.{name}" for name in ("pardiso", "banded", "superlu")}
    assert not loaded & (tools | laws | solvers)


def test_a_name_is_found_without_a_list_of_all_names():
    model = uf.Model(
        uf.mesh.strip(length=1, width=1, thickness=1, cells=(1, 1)), "DISP3D", material=uf.SVK(E=1.0, nu=0.3)
    )
    tracemalloc.start()
    names = [model.force("x1", (0, 0, 1.0)).name for _ in range(3)]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert names == ["force", "force2", "force3"]
    assert peak < 1_000_000


_LINEAR = """
import sys
import umform as uf
from umform_book.linear_algebra import linear_solution
mesh = uf.mesh.strip(length=4, width=1, thickness=0.5, cells=(4, 1))
model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=1.0, nu=0.3))
model.fix("x0")
linear_solution(model, model.force("x1", (0, 0, 1.0)).vector)
print(*sys.modules)
"""


def test_a_linear_solution_loads_no_sparse_matrices():
    run = subprocess.run([sys.executable, "-c", _LINEAR], capture_output=True, text=True, check=True)
    assert not {"scipy.sparse", "matplotlib"} & set(run.stdout.split())
