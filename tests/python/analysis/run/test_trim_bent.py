"""Trimming through a bend: the new elements have the stresses and the energy of the metal, or elements stay whole."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.history_variables import history_of

CURVE = uf.Swift(strength=520.0, offset=0.004, exponent=0.2)
STEEL = uf.J2(E=210e3, nu=0.3, hardening=CURVE)
RADIUS, CELL = 6.0, 6.5 * np.deg2rad(8.0)  # an element of 8 degrees at the middle of a sheet of 1 mm


def strip(lines, material, element="ANS3DEAS", cell="hex8", thickness=1.0, **options):
    """A strip that is clamped where x < 0, and the displacement of its free edge."""
    h = 0.5 * thickness
    mesh = uf.mesh.grid(lines, [0.0, 2.0], [-h, h], cell=cell)
    if "thickness_points" not in options:  # columns whose heights differ change the energy more
        options |= {"thickness_points": 18, "thickness_rule": "graded"}
    model = uf.Model(mesh, element, material=material, **options)
    model.fix(lambda x, y, z: x < 1e-9)
    return model, model.prescribe("x1_lower", "z", name="tip")


def wrapped(lines, material=STEEL, element="ANS3DEAS", cell="hex8", thickness=1.0, **options):
    """A strip that is wrapped around a cylinder."""
    model, tip = strip(lines, material, element, cell, thickness, **options)
    die = uf.Cylinder(centre=(0.0, 0.0, -0.5 * thickness - RADIUS), axis="y", radius=RADIUS)
    model.contact("lower", die, penalty=5e4 * thickness)
    return uf.solve(model, uf.Move(tip, -1.2 * RADIUS, steps=15), frames=0, progress=False).model


def bent_freely(lines):
    """A strip that is bent by a force at its edge: 4 to 9 degrees an element of half the size near the clamp."""
    model, tip = strip(lines, STEEL)
    return uf.solve(model, uf.Move(tip, -7.0, steps=8), frames=0, progress=False).model


def lines_of(cell, through=None):
    """Lines of elements from -2 to 12 elements of 8 degrees; the line nearest to a place is moved there."""
    lines = np.arange(-2.0 * CELL, 12.5 * CELL, cell)
    if through is not None:
        lines[np.abs(lines - through).argmin()] = through
    return lines


@pytest.fixture(scope="module")
def bent():
    return {degrees: wrapped(lines_of(degrees / 8.0 * CELL)) for degrees in (8.0, 4.0)}


def beyond(x, edge="line"):
    """What is left of x on the flat strip stays."""
    return uf.Trim([(x, -1.0), (x, 3.0)], formed=False, edge=edge)


def rest(part):
    """Elastic energy and plastic work of a part."""
    return np.array(part.model.bodies.only.block.energy(part.model.u))


@pytest.mark.parametrize(  # places in elements of 8 degrees
    ("degrees", "place"),
    [(8.0, 3.05), (8.0, 3.4), (8.0, 3.7), (8.0, 4.4), (8.0, 4.6), (4.0, 3.4), (4.0, 4.4), (4.0, 4.65)],
)
def test_the_rest_has_the_energy_of_its_metal(bent, degrees, place):
    model = bent[degrees]
    part = beyond(place * CELL).of(model)
    assert part.remark == "" and part.edge_distance < 1e-9 and (~part.same).any()
    cell = degrees / 8.0
    below = np.floor(place / cell) * cell
    before, after = (rest(beyond((x + 1e-6) * CELL, "elements").of(model)) for x in (below, below + cell))
    share = (place - below) / cell
    expected = before + share * (after - before)
    assert (before < rest(part)).all() and (rest(part) < after).all()
    np.testing.assert_allclose(rest(part), expected, rtol=0.01 if degrees < 8.0 else 0.04)
    lost = part.removed_energies
    removed = np.array([lost.elastic, lost.plastic])
    np.testing.assert_allclose(rest(part) + removed, model.bodies.only.block.energy(model.u), rtol=1e-12)


HILL = uf.Metal(
    E=210e3,
    nu=0.3,
    hardening=CURVE,
    yield_function=uf.Hill48(1.8, 1.2, 2.2),
    back_stress=uf.Chaboche(((4000.0, 40.0),)),
)


def test_metals_with_back_stresses_keep_their_energy():
    model, tip = strip(lines_of(0.5 * CELL), HILL, rolling=(1.0, 0.3, 0.0))
    uf.solve(model, uf.Move(tip, -5.0, steps=6), frames=0, progress=False)
    part = beyond(2.3 * CELL).of(model)
    below, above = (rest(beyond(x * CELL, "elements").of(model)) for x in (2.01, 2.51))
    assert part.remark == "" and (below < rest(part)).all() and (rest(part) < above).all()


def test_enhanced_parameters_of_new_elements_are_in_equilibrium(bent):
    """Another evaluation at the same nodes moves none of them. eq. (2.19)"""
    model = beyond(4.4 * CELL).of(bent[4.0]).model
    before = model.bodies.only.block.alpha
    model.evaluate(model.u)
    model.bodies.only.block.recover(np.zeros_like(model.u))
    model.bodies.only.block.commit()
    assert np.abs(model.bodies.only.block.alpha - before).max() < 1e-6 * np.abs(before).max()


def springback(part):
    """Change of the place of the edge when nothing acts on the part but the clamp; plastic work in that."""
    model = part.model
    work = rest(part)[1]
    model.fix(lambda x, y, z: x < 1e-9, here=True)
    edge, before = model.mesh.nodes("cut"), model.u.reshape(-1, 3).copy()
    result = uf.solve(model, uf.Move(model.unbalanced("cut"), 0.0, steps=2), frames=0, progress=False)
    assert np.abs(result.balance().drift).max() < 1e-4
    assert rest(part)[1] == pytest.approx(work, rel=1e-7)  # its stresses are within the yield surface
    return (model.u.reshape(-1, 3) - before)[edge][:, [0, 2]].mean(axis=0)


def test_springback_is_that_of_an_edge_of_elements_at_the_line_and_of_half_the_size():
    place, cell = 2.4 * CELL, 0.5 * CELL
    part = beyond(place).of(bent_freely(lines_of(cell)))
    exact = beyond(place).of(bent_freely(lines_of(cell, place)))
    assert part.remark == "" and exact.same.all()
    found, expected = springback(part), springback(exact)
    assert np.linalg.norm(found - expected) < 0.005 * np.linalg.norm(expected)
    expected = springback(beyond(place).of(bent_freely(lines_of(0.5 * cell))))
    assert np.linalg.norm(found - expected) < 0.015 * np.linalg.norm(expected)


def test_metal_bent_by_16_degrees_an_element_stays_whole():
    model = bent_freely(lines_of(CELL))
    part, whole = (beyond(1.4 * CELL, edge).of(model) for edge in ("line", "elements"))
    assert "elastic energy" in part.remark and "coarse for the bend" in part.remark and part.same.all()
    np.testing.assert_array_equal(rest(part), rest(whole))


def test_elastic_elements_that_would_store_more_stay_whole():
    elastic = uf.SVK(E=210e3, nu=0.3)
    model = wrapped(lines_of(CELL), elastic, thickness=0.05)
    part = beyond(4.4 * CELL).of(model)
    whole = beyond(4.4 * CELL, "elements").of(model)
    assert "elastic energy" in part.remark and "coarse for the bend" in part.remark
    assert "warning: the edge follows elements" in str(part)
    np.testing.assert_array_equal(part.cells, whole.cells)
    assert part.same.all() and part.removed_energies.elastic == whole.removed_energies.elastic > 0.0


def test_metal_that_never_flowed_keeps_its_stress_in_coarse_elements():
    thin = uf.J2(E=210e3, nu=0.3, hardening=uf.Perfect(2000.0))
    model = wrapped(lines_of(CELL), thin, thickness=0.05)
    assert history_of(model.bodies.only.block)["eqps"].max() == 0.0
    part = beyond(4.4 * CELL).of(model)
    below, above = (rest(beyond(x * CELL, "elements").of(model))[0] for x in (4.01, 5.01))
    assert part.remark == "" and part.edge_distance < 1e-9 and below < rest(part)[0] < above


def test_an_elastic_strip_is_free_of_stress_when_it_is_let_go():
    """Elements beside metal that has not flowed have the initial history."""
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (20, 1)), material=STEEL)
    model.fix("x0")
    load = model.force("x1", (0.0, 0.0, -1.0), "load")
    uf.solve(model, uf.Move(load, 0.3, steps=1), frames=0, progress=False)
    part = beyond(13.3).of(model)
    assert part.remark == "" and (~part.same).any() and rest(part)[0] > 0.01
    assert (part.model.bodies.only.block.state == STEEL.law().initial()).all()
    springback(part)
    assert rest(part)[0] < 1e-12


def test_a_bend_in_elements_of_18_nodes_follows_elements():
    model = wrapped(np.arange(-1.0, 6.0) * 2.0 * CELL, STEEL, "DISP9K3DEAS", "hex18", thickness_points=5)
    part = beyond(4.4 * CELL).of(model)
    assert "8-node" in part.remark
    lost, all_of_it = part.removed_energies, model.bodies.only.block.energy(model.u)
    assert part.same.all() and 0.0 < lost.elastic < all_of_it[0] and 0.0 < lost.plastic < all_of_it[1]
