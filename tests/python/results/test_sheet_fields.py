"""Fields of sheets that touch: in frames, files and reports."""

from __future__ import annotations

import h5py
import meshio
import numpy as np
import pytest

import umform as uf


@pytest.fixture(scope="module")
def rubbed():
    """A block that is pressed onto a plate and pushed along it until it slips; its run."""
    plate = uf.mesh.strip(10.0, 4.0, 1.0, (6, 2))
    block = uf.mesh.strip(4.0, 2.0, 1.0, (3, 2)).moved((2.1, 1.1, 1.0))
    model = uf.Model(uf.mesh.together(a=plate, b=block), material=uf.SVK(E=210e3, nu=0.0))
    model.sheet_contact("upper of a", "lower of b", name="block", friction=0.2, cells=3)
    model.fix("lower of a")
    model.fix("upper of b", "y")
    down, along = (model.prescribe("upper of b", way, name) for way, name in (("z", "down"), ("x", "along")))
    return uf.solve(model, [uf.Move(down, -0.004, steps=2), uf.Move(along, 0.1, steps=4)], progress=False, frames=10)


def test_a_frame_has_pressure_gap_traction_and_slip(rubbed):
    model, points = rubbed.model, rubbed.frames[-1].points
    contact = model.system.sheet_contacts[0]
    under = model.mesh.nodes("lower of b")
    pressure, gap = points["contact_pressure"], points["contact_gap"]
    near = np.isfinite(gap)
    assert set(under) <= set(np.flatnonzero(near)) <= {*under, *model.mesh.nodes("upper of a")}
    assert (pressure[under] > 8.0).all() and not pressure[~near].any()
    assert (gap[under] < 0.0).all()
    assert pressure[under] == pytest.approx(-contact.penalty * gap[under], rel=1e-6)
    mean = np.linalg.norm(points["friction_traction"][under], axis=1)
    assert mean == pytest.approx(0.2 * pressure[under], rel=0.02)
    assert points["friction_traction"][under, 0].max() < 0.0 < points["friction_traction"][:, 0].max()
    assert points["slip"][under] == pytest.approx(np.full(len(under), 0.1), rel=0.1)


def test_a_frame_has_the_points_of_both_sides(rubbed):
    contact, kept = rubbed.model.system.sheet_contacts[0], rubbed.frames[-1].contacts["block"]
    assert len(kept.gap) == sum(one.points for one in contact.passes)
    assert (kept.status == 2).sum() == rubbed["block_slipping"][-1] > 10
    force = 0.5 * (
        kept.area[:, None] * (kept.pressure[:, None] * kept.normal + kept.friction) * (kept.status > 0)[:, None]
    )
    first = contact.passes[0].points
    total = force[:first].sum(axis=0) - force[first:].sum(axis=0)
    assert total == pytest.approx([rubbed[f"block_f{axis}"][-1] for axis in "xyz"], rel=1e-6, abs=1e-6)


def test_files_and_report_have_them(rubbed, tmp_path):
    rubbed.write(tmp_path / "fields.vtkhdf")
    with h5py.File(tmp_path / "fields.vtkhdf") as file:
        assert {"contact_pressure", "contact_gap", "friction_traction", "slip"} <= set(file["VTKHDF/PointData"])
    rubbed.write(tmp_path / "fields.vtu")
    data = meshio.read(next(tmp_path.glob("*.vtu"))).point_data
    assert np.nanmax(data["contact_pressure"]) > 8.0
    rubbed.report(tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text()
    assert "contact block" in text and "between sheets" in text and "contact pressure" in text
