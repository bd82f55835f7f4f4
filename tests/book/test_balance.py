"""The balance of a run on its page: friction is among the works."""

from __future__ import annotations

import numpy as np

import umform as uf
from umform_book.balance import balance_row


def test_the_work_of_friction_is_in_the_balance():
    mesh = uf.mesh.strip(4.0, 2.0, 1.0, (2, 1), cell="hex8")
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=1e4, nu=0.0))
    way = model.prescribe(np.arange(len(mesh.points)), "x", "way")
    model.fix(np.arange(len(mesh.points)), "y")
    press = model.prescribe("upper", "z", "press")
    model.contact("lower", uf.Plane((0.0, 0.0, -0.5), (0.0, 0.0, 1.0)), penalty=1e3, friction=0.3, slip=1e-3)
    steps = [uf.Move(press, -1e-3, steps=2), uf.Move(way, 0.5, steps=10)]
    result = uf.solve(model, steps, progress=False, frames=0)
    assert result["friction_work"][-1] > 0.9 * result["external_work"][-1]
    assert balance_row("block", "pushed", result).drift < 1e-6
