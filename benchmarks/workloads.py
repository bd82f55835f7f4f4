"""Workloads of a second or so, by the public interface alone, so that any commit can run them; CPU seconds as JSON.

``compare.py`` runs them for two commits in turns; by itself it prints the numbers of the umform that Python finds.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import umform as uf
from sheets import LAWS, sheet

#: A run of 24 elements in plane strain, with contact and plasticity, from the import on.
SMALL_RUN = """
import umform as uf
mesh = uf.mesh.strip(length=60, width=2.5, thickness=1, cells=(24, 1))
model = uf.Model(mesh, "BEND8", material=uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(160.0, 500.0)))
model.symmetry("x0", normal="x")
model.fix(range(len(mesh.points)), "y")
punch = model.prescribe("x0_lower", "z", name="punch")
model.contact("lower", uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20), penalty=100, points=2)
uf.solve(model, uf.Move(punch, to=-1.0, steps=4), frames=0, progress=False)
"""


def cpu_seconds(work: Callable[[], object]) -> float:
    """CPU seconds of this process in some work."""
    start = time.process_time()
    work()
    return time.process_time() - start


def start_up(*words: str, times: int = 5) -> float:
    """CPU seconds of some starts of Python with these words, after one that leaves byte code, as pip does."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}

    def start() -> None:
        subprocess.run([sys.executable, *words], check=True, stdout=subprocess.DEVNULL, env=environment)

    start()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for _ in range(times):
        start()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def evaluations(element: str, cells: tuple[int, int]) -> Callable[[], object]:
    """Residuals and tangents of a sheet that flows everywhere."""
    model, u = sheet(element, "J2 plastic", cells)
    model.evaluate(u)
    return lambda: [model.evaluate(u) for _ in range(10)]


def free_bending(frames: int = 0) -> uf.Result:
    """Half of the stroke of the demo on its coarsest mesh: contact, plasticity, a narrow band, much Python."""
    mesh = uf.mesh.strip(length=60, width=10, thickness=1, cells=(24, 1))
    model = uf.Model(mesh, "ANS3DEAS", material=LAWS["J2 plastic"], thickness_order=1, thickness_points=5)
    model.symmetry("x0", normal="x")
    model.fix(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), "y")
    punch = model.prescribe("x0_lower", "z", name="punch")
    model.contact("lower", uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20), penalty=100, points=2)
    return uf.solve(model, uf.Move(punch, to=-7.5, steps=100), frames=frames, progress=False)


def files(result: uf.Result) -> None:
    """All files of a small run: table, 60 frames, a picture and the report, with the loading of what they need."""
    with TemporaryDirectory() as folder:
        result.write(Path(folder) / "history.csv")
        result.write(Path(folder) / "fields.vtkhdf")
        result.plot("punch", "punch_force", Path(folder) / "curve.png")
        result.report(Path(folder) / "report.html")


def bent_plate() -> object:
    """A clamped elastic plate of 50 x 50 elements, bent far: the sparse solver."""
    mesh = uf.mesh.strip(length=50.0, width=50.0, thickness=1.0, cells=(50, 50))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    edge = model.prescribe("x1_lower", "z", name="edge")
    return uf.solve(model, uf.Move(edge, to=8.0, steps=2), frames=0, progress=False)


def bend_of_the_readme() -> float:
    """CPU seconds of `umform bend` with the options of the README: search, pictures, fields and report."""
    options = "--thickness 2 --opening 16 --die-radius 2 --punch-radius 1.5 --material DC04 --angle 90 --overwrite"
    with TemporaryDirectory() as folder:
        return start_up("-m", "umform", "bend", *options.split(), "--out", f"{folder}/bend", times=1)


def files_seconds() -> float:
    """CPU seconds that the files of the run take."""
    result = free_bending(frames=60)
    return cpu_seconds(lambda: files(result))


#: Each workload, as CPU seconds of it.
WORKLOADS: dict[str, Callable[[], float]] = {
    "python -c pass, 5 times": lambda: start_up("-c", "pass"),
    "import numpy, 5 times": lambda: start_up("-c", "import numpy"),
    "umform --version, 5 times": lambda: start_up("-c", "from umform.cli import main; main()", "--version"),
    "import umform; umform.Model, 5 times": lambda: start_up("-c", "import umform; umform.Model"),
    "a run of 24 elements with its start, 5 times": lambda: start_up("-c", SMALL_RUN),
    "evaluate ANS3DEAS, J2": lambda: cpu_seconds(evaluations("ANS3DEAS", (50, 50))),
    "evaluate MI9K3DEAS, J2": lambda: cpu_seconds(evaluations("MI9K3DEAS", (16, 16))),
    "free bending 24x1": lambda: cpu_seconds(free_bending),
    "files of free bending 24x1": files_seconds,
    "umform bend of the README": bend_of_the_readme,
    "bent plate 50x50": lambda: cpu_seconds(bent_plate),
}


def main() -> None:
    """Run them one after the other."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=list(WORKLOADS), action="append", metavar="NAME", help="default: all")
    arguments = parser.parse_args()
    uf.set_threads(1)
    print(json.dumps({name: WORKLOADS[name]() for name in arguments.only or WORKLOADS}, indent=1))


if __name__ == "__main__":
    main()
