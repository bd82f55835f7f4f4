"""Contact over cells: the tangent, resultants, the edge of contact, work along the way, friction, multipliers."""

from __future__ import annotations

import numpy as np
import pytest

from umform import _core
from umform.errors import InvalidValue
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Plane, Sphere, UserSurface

PENALTY = 50.0


def ellipsoid(x):
    """sqrt of the form of an ellipsoid less one: no distance, and a gradient that is not of length one."""
    axes, centre = np.array([4.0, 6.0, 3.0]), np.array([1.5, 1.5, -2.9])
    D = np.diag(axes**-2.0)
    y = x - centre
    root = np.sqrt(np.einsum("ni,ij,nj->n", y, D, y))
    n = y @ D / root[:, None]
    H = (D - n[:, :, None] * n[:, None, :]) / root[:, None, None]
    return root - 1.0, n, H


TOOLS = {
    "plane": Plane((1.5, 1.5, -0.02), (0.2, 0.1, 1.0)),
    "cylinder": Cylinder((1.5, 0.0, -4.9), (0.3, 1.0, 0.0), 5.0),
    "bore": Cylinder((1.2, 0.0, 9.95), (0.2, 1.0, 0.0), 10.0, inside=True),
    "sphere": Sphere((1.5, 1.4, -4.9), 5.0),
    "bowl": Sphere((1.5, 1.4, 9.95), 10.0, inside=True),
    "ellipsoid": UserSurface(ellipsoid),
}


def plate(cell="hex8", cells=(3, 3), amount=0.1):
    """A plate of 3 x 3 x 1 above z = 0 whose faces are no rectangles."""
    mesh = strip(3.0, 3.0, 1.0, cells, cell=cell)
    mesh.points[:, 2] += 0.5
    mesh.points[:, :2] += amount * np.sin(2.0 * mesh.points[:, 1::-1] + 0.3)
    return mesh


def block_over(mesh, tool, cells=3, law=None):
    law = _core.penalty_law(PENALTY) if law is None else law
    return _core.contact_cells(mesh.facets("lower"), mesh.points, cells, tool.kernel(), law)


def waved(mesh, rng, amount=0.02):
    return amount * rng.normal(size=mesh.points.size)


def respond(block, u, way=None):
    """Forces on the nodes; with a way what the tangent makes of it."""
    pattern = _core.Pattern(np.arange(u.size, dtype=np.int32), [block.connectivity], block.symmetric)
    f, product, values = np.zeros(u.size), np.zeros(u.size), np.zeros(len(pattern.indices))
    block.evaluate(u, pattern.scatter(block.connectivity), f, values, way, None if way is None else product)
    return (f, product) if way is not None else f


def differences(block, u, way, step=2e-6):
    return (respond(block, u + step * way) - respond(block, u - step * way)) / (2.0 * step)


def assert_exact_tangent(block, mesh, u, rng, tolerance=1e-8):
    """Against fourth-order differences along random ways."""
    for _ in range(4):
        way = rng.normal(size=u.size)
        exact = respond(block, u, way)[1]
        near, far = differences(block, u, way), differences(block, u, way, 4e-6)
        measured = (4.0 * near - far) / 3.0
        assert np.abs(exact).max() > 1.0
        np.testing.assert_allclose(exact, measured, rtol=0, atol=tolerance * np.abs(exact).max())


# The tangent ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("tool", TOOLS)
def test_the_tangent_is_exact(tool, cell, rng):
    mesh = plate(cell)
    block = block_over(mesh, TOOLS[tool])
    u = waved(mesh, rng)
    respond(block, u)
    share = block.found().share
    assert ((share > 0.0) & (share < 1.0)).any()  # edges of contact pass through cells
    assert_exact_tangent(block, mesh, u, rng)


@pytest.mark.parametrize("cells", [1, 2, 5])
def test_the_tangent_is_exact_for_any_number_of_cells(cells, rng):
    mesh = plate("hex18", (2, 2))
    assert_exact_tangent(block_over(mesh, TOOLS["sphere"], cells), mesh, waved(mesh, rng), rng)


@pytest.mark.parametrize("tool", ["cylinder", "bowl", "ellipsoid"])
def test_the_tangent_is_exact_with_multipliers(tool, rng):
    mesh = plate()
    block = block_over(mesh, TOOLS[tool])
    block.multipliers = np.where(rng.random(block.points) < 0.5, 3.0 * rng.random(block.points), 0.0)
    assert_exact_tangent(block, mesh, waved(mesh, rng), rng)


@pytest.mark.parametrize("way", [1e-4, 3.7e-3, 0.2], ids=["stick", "both", "slip"])
@pytest.mark.parametrize("tool", TOOLS)
def test_the_tangent_is_exact_with_friction(tool, way, rng):
    """The bound of a cell is mu times its mean pressure, whose derivative is not that of a point."""
    mesh = plate()
    law = _core.coulomb_law(PENALTY, 1.5, 0.01, _core.coulomb_friction([0.0, 5.0], [0.3, 0.2], 1.0, 0.0, np.inf))
    block = block_over(mesh, TOOLS[tool], 3, law)
    u = waved(mesh, rng)
    block.locate(np.zeros(u.size))
    block.begin()
    respond(block, u)
    block.commit()
    u += np.tile([way, 0.3 * way, -0.02], len(mesh.points)) + waved(mesh, rng, 0.1 * way)
    respond(block, u)
    status = block.found().active
    assert (status > 0).sum() > 5
    if tool != "ellipsoid":
        assert {1e-4: (status == 1).sum() > 5, 3.7e-3: len(set(status) & {1, 2}) == 2, 0.2: (status == 2).sum() > 5}[
            way
        ]
    assert_exact_tangent(block, mesh, u, rng)


@pytest.mark.parametrize("friction", [False, True])
def test_the_row_of_a_motion_of_the_tool_is_the_derivative_of_its_force(friction, rng):
    mesh = plate()
    bound = _core.coulomb_friction([0.0], [0.3], 1.0, 0.0, np.inf)
    law = _core.coulomb_law(PENALTY, 1.5, 0.01, bound) if friction else None
    block = block_over(mesh, TOOLS["sphere"], 3, law)
    block.locate(np.zeros(mesh.points.size))
    block.begin()
    u = waved(mesh, rng)
    respond(block, u)
    block.commit()
    u += np.tile([0.01, 0.0, 0.0], len(mesh.points))
    w, omega, p = rng.normal(size=3), rng.normal(size=3), rng.normal(size=3)

    def conjugate(u):
        respond(block, u)
        found = block.found()
        return -float((found.force * (w + np.cross(omega, found.x - p))).sum())

    way, step = rng.normal(size=u.size), 1e-6
    measured = (conjugate(u + step * way) - conjugate(u - step * way)) / (2.0 * step)
    respond(block, u)
    assert block.row(w, omega, p) @ way == pytest.approx(measured, rel=1e-7)


# Forces -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("cells", [1, 2, 3])
def test_a_uniform_pressure_gives_its_consistent_forces_on_any_faces(cell, cells):
    """A plane 0.01 deep: the same as by Gauss points that integrate exactly."""
    mesh = plate(cell, amount=0.25)
    tool = Plane((0.0, 0.0, 0.01), (0.0, 0.0, 1.0))
    exact = _core.contact_block(
        mesh.facets("lower"), mesh.points, (6, 6), False, tool.kernel(), _core.penalty_law(PENALTY)
    )
    u = np.zeros(mesh.points.size)
    np.testing.assert_allclose(respond(block_over(mesh, tool, cells), u), respond(exact, u), atol=1e-13)


def parabola(x0):
    """A tool with the gap z + (x - x0)^2 / 20 - 0.01, whose slope in the middle of a cell is that of its chord."""

    def gap(x):
        zero, one = np.zeros(len(x)), np.ones(len(x))
        n = np.column_stack([(x[:, 0] - x0) / 10.0, zero, one])
        H = np.zeros((len(x), 3, 3))
        H[:, 0, 0] = 0.1
        return x[:, 2] + (x[:, 0] - x0) ** 2 / 20.0 - 0.01, n, H

    return UserSurface(gap)


@pytest.mark.parametrize("graded", [False, True], ids=["equal", "graded"])
@pytest.mark.parametrize(("round_", "exact"), [(True, 1e-5), (False, 1e-12)], ids=["cylinder", "parabola"])
def test_the_resultant_of_cells_is_where_the_tool_touches(round_, exact, graded):
    """However coarse they are, and wherever the edges of contact lie in them; that of points is not."""
    mesh = strip(8.0, 1.0, 1.0, (8, 1))
    mesh.points[:, 2] += 0.5
    if graded:
        mesh.points[:, 0] = 8.0 * (mesh.points[:, 0] / 8.0) ** 1.5
    u = np.zeros(mesh.points.size)
    errors = {"cells": [], "points": []}
    for x in np.linspace(3.0, 4.0, 11):
        tool = Cylinder((x, 0.0, -9.95), "y", 10.0) if round_ else parabola(x)
        law = _core.penalty_law(PENALTY)
        blocks = {
            "cells": block_over(mesh, tool, 3),
            "points": _core.contact_block(mesh.facets("lower"), mesh.points, (2, 2), False, tool.kernel(), law),
        }
        for name, block in blocks.items():
            respond(block, u)
            found = block.found()
            moment, force = np.cross(found.x, found.force).sum(axis=0), found.force.sum(axis=0)
            errors[name].append(np.hypot(force[0], moment[1] / 10.0 + x * force[2] / 10.0) / abs(force[2]))
    assert max(errors["cells"]) < exact
    assert max(errors["points"]) > 1e-3


def test_the_resultant_on_distorted_faces_is_nearer_to_where_the_tool_touches_than_that_of_as_many_points():
    mesh = plate(cells=(6, 3), amount=0.08)
    u = np.zeros(mesh.points.size)
    errors = {"cells": [], "points": []}
    for x in np.linspace(1.2, 1.8, 11):
        tool, law = Cylinder((x, 0.0, -4.98), "y", 5.0), _core.penalty_law(PENALTY)
        blocks = {
            "cells": block_over(mesh, tool, 3),
            "points": _core.contact_block(mesh.facets("lower"), mesh.points, (5, 5), False, tool.kernel(), law),
        }
        for name, block in blocks.items():
            respond(block, u)
            force = block.found().force.sum(axis=0)
            errors[name].append(abs(force[0] / force[2]))
    assert max(errors["cells"]) < 0.1 * max(errors["points"])


def test_the_force_has_no_stairs():
    """A cylinder goes along a flat strip: the force of points jumps as they come and go, that of cells hardly moves."""
    mesh = strip(8.0, 1.0, 1.0, (8, 1))
    mesh.points[:, 2] += 0.5
    u = np.zeros(mesh.points.size)
    force = {"cells": [], "points": []}
    for x in np.linspace(3.0, 4.0, 201):
        tool = Cylinder((x, 0.0, -9.99), "y", 10.0)
        law = _core.penalty_law(PENALTY)
        points = _core.contact_block(mesh.facets("lower"), mesh.points, (3, 3), False, tool.kernel(), law)
        force["points"].append(respond(points, u)[2::3].sum())
        force["cells"].append(respond(block_over(mesh, tool, 3), u)[2::3].sum())
    bend = {name: np.abs(np.diff(values, 2)).max() for name, values in force.items()}
    assert bend["points"] > 0.005 * abs(np.mean(force["points"]))
    assert bend["cells"] < 0.02 * bend["points"]


def test_many_cells_converge_to_the_integral():
    """Vertical force of a cylinder on a flat strip, by fine quadrature of the exact gap."""
    mesh = strip(8.0, 1.0, 1.0, (8, 1))
    mesh.points[:, 2] += 0.5
    tool = Cylinder((3.3, 0.0, -9.9), "y", 10.0)
    x = np.linspace(0.0, 8.0, 800001)
    rho = np.hypot(x - 3.3, 9.9)
    exact = -PENALTY * np.trapezoid(np.minimum(rho - 10.0, 0.0) * 9.9 / rho, x)
    errors = []
    for cells in (2, 4, 8):
        force = -respond(block_over(mesh, tool, cells), np.zeros(mesh.points.size))[2::3].sum()
        errors.append(force / exact - 1.0)
    assert errors[0] < errors[1] < errors[2] < 0.0  # chords: softer than the penalty says, and less so with the square
    assert errors[0] / errors[2] == pytest.approx(16.0, rel=0.3)


# What is found ----------------------------------------------------------------------------------------------


def test_what_was_found_is_that_of_the_forces(rng):
    mesh = plate()
    block = block_over(mesh, TOOLS["sphere"])
    u = waved(mesh, rng)
    respond(block, u + np.tile([0.0, 0.0, 1.0], len(mesh.points)))
    block.commit()
    f = respond(block, u)
    found = block.found()
    np.testing.assert_allclose(found.force.sum(axis=0), f.reshape(-1, 3).sum(axis=0), atol=1e-12)
    np.testing.assert_allclose(found.pressure, -PENALTY * found.gap, rtol=1e-13)
    assert found.penetration == pytest.approx(-found.gap.min(), rel=1e-13)
    assert block.penetration == found.penetration
    assert ((found.share > 0.0) & (found.share <= 1.0)).all()
    assert found.contact_work > 0.0
    assert block.state.shape == (block.points, 5)
    assert not block.symmetric
    assert block.law.symmetric
    block.multipliers = 3.0 * rng.random(block.points)
    respond(block, u)
    found = block.found()
    np.testing.assert_allclose(found.pressure, block.multipliers[found.points] - PENALTY * found.gap, rtol=1e-12)


@pytest.mark.parametrize("lift", [0.15, 2.0], ids=["near", "far"])
def test_what_a_cell_stores_comes_back(lift):
    """In one increment in, in one out, whether the facets are looked at then or are far."""
    mesh = plate()
    block = block_over(mesh, TOOLS["sphere"])
    works = []
    for way in (lift, 0.0, lift, 0.0):
        respond(block, np.tile([0.0, 0.0, way], len(mesh.points)))
        works.append(block.found().contact_work)
        block.commit()
    found, whole = block.found(), block.found().share == 1.0
    assert works[1] == works[3] > 0.0
    assert abs(works[2]) < 1e-15
    assert whole.any()
    assert works[1] > 0.5 / PENALTY * float(found.pressure**2 @ found.area)  # edges: the square of the mean is less


def test_a_penalty_that_a_symmetric_pattern_cannot_take_is_refused(rng):
    mesh = plate()
    block = block_over(mesh, TOOLS["sphere"])
    pattern = _core.Pattern(np.arange(mesh.points.size, dtype=np.int32), [block.connectivity], True)
    f, values = np.zeros(mesh.points.size), np.zeros(len(pattern.indices))
    with pytest.raises(ValueError, match="symmetric"):
        block.evaluate(np.zeros(f.size), pattern.scatter(block.connectivity), f, values, None, None)


def test_facets_that_are_far_are_left_out_and_nothing_is_missed(rng):
    """A cell touches with its corner before its mean place does; a function of the user is never far."""
    mesh = strip(12.0, 12.0, 1.0, (12, 12))
    mesh.points[:, 2] += 0.5
    ball = Sphere((6.2, 5.7, -5.9), 6.0)
    near = block_over(mesh, ball, 1)
    all_of_them = block_over(mesh, UserSurface(lambda x: ball.kernel().gap(x)), 1)
    u, far = np.zeros(mesh.points.size), []
    way = rng.normal(size=3) * (0.3, 0.3, 0.0)
    for number in range(20):
        u = u + np.tile(way + np.array([0.0, 0.0, 0.05 * (-1) ** number]), len(mesh.points)) + waved(mesh, rng, 0.01)
        np.testing.assert_allclose(respond(near, u), respond(all_of_them, u), atol=1e-13)
        far.append(near.far_facets)
    assert min(far[1:]) > 30
    assert all_of_them.far_facets == 0


def test_round_off_is_what_errors_of_the_positions_make(rng):
    """Of the same size as that of points, and never below what random errors do."""
    mesh = plate()
    block = block_over(mesh, TOOLS["sphere"])
    u = waved(mesh, rng)
    f = respond(block, u)
    estimate = np.sqrt(block.round_off_squared)
    size, x = 1e-8, mesh.points.ravel() + u
    for _ in range(5):
        change = respond(block, u + size * x * rng.uniform(-1.0, 1.0, u.size)) - f
        assert 1e-3 * estimate < np.linalg.norm(change) / size < estimate


def test_any_number_of_threads_gives_the_same_bits(rng):
    import umform

    mesh = strip(24.0, 24.0, 1.0, (12, 12))
    mesh.points[:, 2] += 0.5
    block = block_over(mesh, Sphere((12.0, 11.0, -29.8), 30.0))
    u, way = waved(mesh, rng), rng.normal(size=mesh.points.size)
    before, answers = umform.threads(), []
    for count in (1, 2, 3, 7):
        umform.set_threads(count)
        answers.append(respond(block, u, way))
    umform.set_threads(before)
    assert block.found().share.size > 64
    for answer in answers[1:]:
        np.testing.assert_array_equal(answer, answers[0])


# Runs -------------------------------------------------------------------------------------------------------


def bent(cells=3, steps=20, cell="hex8", **options):
    """A short elastic strip over a cylinder, and its result."""
    import umform as uf
    from umform import materials as mt

    name = {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}[cell]
    model = Model(strip(20.0, 4.0, 1.0, (10, 1), cell=cell), name, material=mt.SVK(E=1000.0, nu=0.3))
    model.symmetry("x0", normal="x")
    punch = model.prescribe("x0_lower", "z", name="punch")
    model.fix(np.intersect1d(model.mesh.nodes("x0_lower"), model.mesh.nodes("y0_lower")), "y")
    tool = Cylinder((10.0, 0.0, -5.5), "y", 5.0)
    contact = model.contact("lower", tool, cells=cells, name="tool", **{"penalty": 50.0, **options})
    return model, contact, uf.solve(model, uf.Move(punch, to=-4.0, steps=steps))


@pytest.mark.parametrize("options", [{}, {"penalty": 1000.0}, {"friction": 0.1}, {"cell": "hex18", "cells": 5}])
def test_the_balance_closes_as_the_increments_get_smaller(options):
    drift = [np.abs(bent(steps=steps, **options)[2].balance().drift).max() for steps in (20, 80)]
    assert drift[1] < 1e-4
    assert drift[1] < 0.3 * drift[0]


def test_contact_work_is_a_column_and_the_energy_of_contact():
    _, contact, result = bent()
    np.testing.assert_array_equal(result["tool_contact_work"], result["contact_energy"])
    found = contact.found
    energy = 0.5 / 50.0 * float(found.pressure**2 @ found.area)
    assert result["contact_energy"][-1] > 0.5 * energy > 0.0


def test_multipliers_take_the_penetration_away():
    _, contact, result = bent(penalty=50.0, penetration=1e-3, augmented=True)
    plain = bent()[2]
    assert plain["tool_penetration"].max() > 0.01
    assert np.abs(contact.found.held.gap).max() <= 1e-3
    assert contact.multipliers.max() > 0.0
    assert -result["punch_force"][-1] == pytest.approx(-plain["punch_force"][-1], rel=0.02)


@pytest.mark.parametrize("friction", [None, 0.2])
def test_a_tool_that_is_pressed_finds_its_force(friction):
    import umform as uf
    from umform import materials as mt

    model = Model(strip(20.0, 4.0, 1.0, (10, 1)), "ANS3DEAS", material=mt.SVK(E=1000.0, nu=0.3))
    model.fix("x0")
    tool = Cylinder((16.3, 0.0, 5.48), "y", 5.0)  # inside: a tool that just touches holds no corner of a cell
    contact = model.contact("upper", tool, penalty=200.0, cells=3, friction=friction, name="punch")
    force = model.press(contact, "z", name="force")
    result = uf.solve(model, uf.Move(force, to=-0.5, steps=4))
    assert contact.resultant()[0][2] == pytest.approx(0.5, rel=1e-6)
    assert result["iterations"].max() <= 9


def test_cells_or_points():
    model, contact, _ = bent(steps=2)
    assert (contact.cells, contact.points, contact.symmetric) == (3, 3, False)
    assert contact.block.points == 9 * 10
    wrong = [{"cells": n} for n in (0, 21, True, "3")] + [{"cells": 3, "points": 2}, {"cells": "auto", "points": 2}]
    wrong += [{"cells": 3, "ripple": 0.01}, {"cells": "auto", "ripple": 0.0}, {"ripple": 0.01}]
    for options in wrong:
        with pytest.raises(InvalidValue, match=r"cells|ripple"):
            model.contact("lower", Plane((0, 0, -9.0)), name="other", **options)


# How many ---------------------------------------------------------------------------------------------------


def plastic(steps=60, **rule):
    """A plastic strip over a cylinder, its contact and the force over the way."""
    import umform as uf
    from umform import materials as mt

    law = mt.J2(E=2e5, nu=0.3, hardening=mt.Perfect(200.0))
    model = Model(strip(24.0, 1.0, 1.0, (12, 1)), "ANS3DEAS", material=law)
    model.symmetry("x0", normal="x")
    model.fix(np.arange(len(model.mesh.points)), "y")
    punch = model.prescribe("x0_lower", "z", name="punch")
    contact = model.contact("lower", Cylinder((14.0, 0.0, -6.5), "y", 6.0), name="tool", penalty=2000.0, **rule)
    result = uf.solve(model, uf.Move(punch, to=-5.0, steps=steps), frames=0)
    return contact, result["punch"], result["punch_force"], result


def ripple_over_force(force, finest, way):
    """Difference of two curves less a cubic polynomial, root mean square over the force."""
    difference = force - finest
    difference = difference - np.polynomial.Polynomial.fit(way, difference, 3)(way)
    return np.sqrt(np.mean(difference**2) / np.mean(finest**2))


def test_the_ripple_that_is_measured_is_below_the_one_expected():
    _, way, finest, _ = plastic(cells=20)
    for rule in ({"cells": 3}, {"cells": "auto", "ripple": 0.004}):
        contact, _, force, result = plastic(**rule)
        measured = ripple_over_force(force, finest, way)
        assert 0.05 * contact.ripple < measured < contact.ripple
        assert f"contact tool: {contact.cells} x {contact.cells} cells a face, ripple" in "".join(result.events)


def test_the_number_of_cells_follows_from_the_ripple_and_the_contact():
    def contact(length=20.0, **options):
        import umform as uf

        steel = uf.J2(E=2e5, nu=0.3, hardening=uf.materials.Perfect(200.0))
        model = Model(strip(length, 2.0, 1.0, (10, 1)), "ANS3DEAS", material=steel)
        return model.contact("lower", Cylinder((10.0, 0.0, -6.0), "y", 5.5), cells="auto", **options)

    plain = contact()
    assert plain.cells == 8  # 2 / sqrt(12 * 0.001 * 5.5 * 1)
    assert plain.points == 8
    assert plain.ripple == pytest.approx((2.0 / 8.0) ** 2 / (12.0 * 5.5), rel=1e-6)
    assert contact(length=40.0).cells == 16
    assert contact(length=400.0).cells == 20
    assert contact(ripple=0.9, penalty=1.0).cells == 3
    short = contact(ripple=0.9, penetration=1e-3)
    assert short.cells == int(np.ceil(2.0 / (2.0 * np.sqrt(2.0 * 5.5 * 1e-3))))  # by the length that touches
