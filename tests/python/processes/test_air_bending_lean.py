"""What a bend does not pay: libraries for one function, figures that are drawn twice."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline

from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.files import write_files
from umform.processes.air_bending.spline import Spline

_TYPED = """
import sys
from umform.cli import main
sys.argv = ["umform", "bend", "--stroke", "0.2", "--material", "DC04", "--layers", "1", "--elements-per-thickness", "1",
            "--out", sys.argv[1]]
try:
    main()
finally:
    print("loaded", *sys.modules)
"""


def test_the_spline_is_that_of_scipy():
    rng = np.random.default_rng(5)
    for knots in (4, 5, 30):
        x, y = np.sort(rng.uniform(0.0, 3.0, knots)), rng.normal(size=(knots, 2))
        at = np.linspace(0.0, x[-1], 57)
        ours, theirs = Spline(x, y), CubicSpline(x, y)
        np.testing.assert_allclose(ours(at), theirs(at), atol=1e-12 * np.abs(theirs(at)).max())
        np.testing.assert_allclose(ours.slope(at), theirs(at, 1), atol=1e-12 * np.abs(theirs(at, 1)).max())


def test_a_bend_loads_no_library_for_one_function(tmp_path):
    run = subprocess.run(
        [sys.executable, "-c", _TYPED, str(tmp_path / "out")], capture_output=True, text=True, check=False
    )
    loaded = set(run.stdout[run.stdout.index("loaded") :].split())
    assert "umform.processes.air_bending.files" in loaded
    assert (tmp_path / "out" / "report.html").exists()
    assert not loaded & {"scipy.interpolate", "scipy.optimize", "scipy.spatial", "meshio"}


def test_each_figure_is_drawn_once_for_each_kind_of_file(tmp_path, monkeypatch):
    drawn, savefig = [], Figure.savefig

    def counted(self, *arguments, **options):
        drawn.append((id(self), options.get("format", "png")))
        savefig(self, *arguments, **options)

    bend = air_bending(AirBending(stroke=0.4, elements_per_thickness=1.0, layers=1, increment=0.025), progress=False)
    monkeypatch.setattr(Figure, "savefig", counted)
    write_files(tmp_path, bend)
    assert len(drawn) == len(set(drawn)) == 6
