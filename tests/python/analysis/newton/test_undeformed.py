"""Contact in the first increment of an undeformed sheet: cutting it does not help, so it gets more iterations."""

from __future__ import annotations

import pytest

import umform as uf
from umform.analysis.newton.divergence_guard import DivergenceGuard


@pytest.mark.parametrize("gap", [0.0, 0.015])
def test_only_the_first_increment_of_a_sheet_that_tools_touch_gets_more_iterations(gap, monkeypatch):
    extended = []
    begun = DivergenceGuard.__init__

    def noting(self, system, indefinite, **more):
        extended.append(more["extended"])
        begun(self, system, indefinite, **more)

    monkeypatch.setattr(DivergenceGuard, "__init__", noting)
    model = uf.Model(uf.mesh.strip(2.0, 1.0, 1.0, (2, 1)), material=uf.SVK(E=1000.0, nu=0.3))
    for nodes, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(nodes, normal)
    plate = model.tool("plate", uf.Plane((0.0, 0.0, 0.5 + gap), (0.0, 0.0, -1.0)))
    model.contact("upper", plate, name="on_plate", penalty=1e4)
    way = uf.Move(model.drive(plate, "-z", name="way"), 0.03, steps=3)
    along_tangents = uf.NewtonOptions(extrapolate=0)  # an extrapolated increment gets none in any case
    uf.solve(model, way, options=along_tangents, progress=False)
    assert extended[0] is (gap == 0.0)
    assert not any(extended[1:])
