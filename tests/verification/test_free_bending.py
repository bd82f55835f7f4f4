"""Free bending of a strip over a cylinder, the example of the project: forces, springback, smoothness of the contact.

The geometry is a reconstruction (see reference/free_bending.csv).
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import umform as uf
from umform.processes import Bending, FreeBending, free_bending
from umform.processes.bending.case import build
from umform.solvers import available
from umform_book.free_bending.reproduction import case_of, rows
from umform_book.free_bending.runs import RECOMMENDED

from .cases import free_bending as strip_over_cylinder

needs_pardiso = pytest.mark.skipif(not available()["pardiso"], reason="MKL is not installed")

ROWS = rows()


@cache
def bent(case: FreeBending) -> Bending:
    """A case and what came out of it, computed once."""
    return free_bending(case, progress=False)


def run(
    cells: tuple[int, int], element: str, points: int | str, steps: int = 300, recommended: bool = False
) -> Bending:
    options = RECOMMENDED if recommended else {}
    return bent(FreeBending(mesh=cells, element=element, contact=points, steps=steps, **options))


def force(found: Bending, u: float) -> float:
    return float(np.interp(u, *found.loading))


def name_of(row: dict[str, str]) -> str:
    return f"{row['cells']} {row['element']} {row['contact_points']}"


@pytest.mark.parametrize("row", ROWS, ids=name_of)
def test_forces_of_the_table(row, book):
    found = bent(case_of(row))
    tolerance = 0.01 if row["recommended"] == "1" else 0.005
    name = f"{row['element']} {row['cells']}, contact {row['contact_points']}"
    name += ", order 3, E_33 tied, 8 points" if row["recommended"] == "1" else ""
    book("free bending (reconstruction)", name, "force at u = 15, N", float(row["F15"]), force(found, 15))
    for u in (2, 5, 10, 15):
        assert force(found, u) == pytest.approx(float(row[f"F{u}"]), rel=tolerance)


@pytest.mark.parametrize("row", [row for row in ROWS if row["u_unloaded"]], ids=name_of)
def test_displacement_at_zero_force(row):
    found = bent(case_of(row))
    assert found.F[-1] == pytest.approx(0.0, abs=1e-5)
    assert found.zero_force == pytest.approx(float(row["u_unloaded"]), rel=0.005)
    springback = 15 - found.zero_force
    assert 0.2 < springback < 0.4


@pytest.mark.parametrize("steps", [150, 600])
def test_number_of_steps_changes_little(steps):
    other, usual = run((24, 1), "ANS3DEAS", 2, steps), run((24, 1), "ANS3DEAS", 2)
    assert force(other, 15) == pytest.approx(force(usual, 15), rel=0.0005)
    assert other.zero_force == pytest.approx(usual.zero_force, rel=0.0005)


def test_tool_and_punch_are_in_equilibrium():
    found = run((24, 1), "ANS3DEAS", 2)
    assert -found.result["cylinder_fz"] == pytest.approx(found.F, abs=1e-6 * found.F.max())


def test_more_contact_points_smooth_the_curve():
    """Nodes are rougher than 2 x 2 points, and these than 5 x 5, by jumps and by deviation from a smooth curve."""
    nodes, two, five = (run((24, 1), "ANS3DEAS", points) for points in ("nodes", 2, 5))
    assert nodes.jump > 3 * two.jump
    assert two.jump > 1.3 * five.jump
    assert nodes.roughness > 3 * two.roughness > 9 * five.roughness


def test_nodal_contact_climbs_stairs():
    """Whenever a line of nodes takes over from the next one: four times after u = 2, each time by 12 to 14 %."""
    found = run((24, 1), "ANS3DEAS", "nodes")
    u = np.linspace(2, 14.5, 1001)
    rise = np.interp(u + 0.5, *found.loading) / np.interp(u, *found.loading) - 1
    stairs = np.flatnonzero(np.diff((rise > 0.08).astype(int)) == 1)
    assert len(stairs) == 4
    for first in stairs:
        assert 0.12 < rise[first : first + 50].max() < 0.14


def test_18_nodes_need_three_contact_points():
    """Faces with 9 nodes: 2 x 2 points are as jumpy as the nodes of the 8-node mesh, 3 x 3 are the least."""
    two, three = (run((12, 1), "MI9K3DEAS", points) for points in (2, 3))
    assert two.jump > run((24, 1), "ANS3DEAS", "nodes").jump
    assert three.jump < 0.5 * two.jump


@needs_pardiso
def test_threads_beside_pardiso_give_the_same_bits():
    """MKL and the kernels share a pool of threads; what the kernels add up does not depend on its size."""
    model, punch = build(FreeBending(mesh=(48, 2), **RECOMMENDED))
    result = uf.solve(model, uf.Move(punch, to=-1.0, steps=4), frames=0, solver="pardiso")
    assert result.solver == "pardiso"
    u = model.u + 1e-3 * np.random.default_rng(1).normal(size=model.u.size)  # off equilibrium, in flow and contact
    before, found = uf.threads(), []
    try:
        for count in (1, 2):
            uf.set_threads(count)
            evaluation = model.evaluate(u)
            found.append((evaluation.residual, evaluation.values, evaluation.force_scale))
    finally:
        uf.set_threads(before)
    assert evaluation.active.any()
    for one, two in zip(*found, strict=True):
        np.testing.assert_array_equal(one, two)


@pytest.mark.long
def test_paper_elements_are_too_stiff_in_the_hinge():
    """Order 1 ends 75 % over the fine continuum meshes (23 N); order 3 with tying meets them."""
    paper, better = run((48, 2), "ANS3DEAS", 2), run((48, 2), "ANS3DEAS", 2, recommended=True)
    assert force(paper, 15) == pytest.approx(40.52, rel=0.005)
    assert force(better, 10) == pytest.approx(23.2, rel=0.03)


@pytest.mark.long
def test_one_element_over_the_width_tilts():
    """A warning: with the recommended setting one bilinear element over the width collapses."""
    assert run((24, 1), "ANS3DEAS", 2, recommended=True).forces[-1] == pytest.approx(10.9, rel=0.02)


@pytest.mark.long
def test_18_nodes_need_higher_modes_that_vary_in_the_surface():
    """Fine continuum meshes give 21.6 and 23.2 N at u = 5 and 10, and 21 to 23 N at u = 15."""
    nine = run((24, 2), "MI9K3DEAS", 3, recommended=True)
    model, punch = strip_over_cylinder((24, 2), "MI9K3DEAS", 3, order_modes=1, **RECOMMENDED)
    result = uf.solve(model, uf.Move(punch, to=-15.0, steps=300), frames=0)
    one = np.interp((5, 10, 15), -result["punch"], -result["punch_force"])
    assert [force(nine, u) for u in (5, 10, 15)] == pytest.approx([22.13, 24.00, 24.00], abs=0.01)
    assert one == pytest.approx([23.10, 25.58, 25.32], abs=0.01)


@pytest.mark.long
def test_hinge_localises_so_that_the_mesh_matters():
    """The agreement of one mesh with the continuum (23.2 N) is worth no more than this scatter."""
    found = [run((nx, 2), "ANS3DEAS", 2, recommended=True).forces[2] for nx in (24, 48, 96)]
    assert found == pytest.approx([25.1, 23.5, 25.2], abs=0.06)
