"""Cut edges of sheets that touch: their rims."""

from __future__ import annotations

import numpy as np
import pytest
from sheet_forces import check_tangent, forces_of

import umform as uf
from umform.model.contact.sheets.faces import cut_edges


def crossed(cell="hex8", layers=1, **options):
    """A plate, and a small block on it that reaches beyond its edges."""
    plate = uf.mesh.strip(4.0, 3.0, 1.0, (4, 3), cell=cell, layers=layers)
    block = uf.mesh.strip(1.6, 1.6, 0.6, (2, 2), cell=cell).moved((3.1, 2.1, 0.8))
    mesh = uf.mesh.together(a=plate, b=block)
    model = uf.Model(mesh, "ANS3DEAS" if cell == "hex8" else "MI9K3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    contact = model.sheet_contact("upper of a", "lower of b", name="edge", penalty=1e3, **options)
    _ = model.system.pattern
    return model, contact


def pressed(model, size=0.02, sink=0.1):
    """A displacement at which the block is in the plate, with both a little bent."""
    mesh, u = model.mesh, size * np.random.default_rng(4).standard_normal(model.mesh.points.shape)
    above = np.unique(mesh.connectivity[mesh.faces["lower of b"][:, 0]])
    u[above, 2] -= sink
    return u.ravel()


def test_cut_edges_are_where_a_sheet_ends():
    for cell, count in (("hex8", 4), ("hex18", 6)):
        mesh = uf.mesh.strip(4.0, 3.0, 1.0, (4, 3), cell=cell, layers=2)
        for face, z in (("upper", 0.5), ("lower", -0.5)):
            nodes, at = cut_edges(mesh, mesh.face_set(face))
            assert nodes.shape == (14, count) and at.shape == (14, 2)
            own, across = mesh.points[nodes[:, : count // 2]], mesh.points[nodes[:, count // 2 :]]
            assert np.allclose(own[..., 2], z)
            assert np.allclose(np.abs(own - across), [0.0, 0.0, 1.0])
            facets = mesh.points[mesh.facets(face)]
            for row, (facet, side) in zip(own, at, strict=True):
                assert np.allclose(row[0], facets[facet, side]) and np.allclose(row[1], facets[facet, (side + 1) % 4])


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("options", [{"points": 5}, {"cells": 4}], ids=str)
def test_the_tangent_on_rims_is_the_derivative_of_the_forces(cell, options):
    model, contact = crossed(cell, **options)
    u = pressed(model, 0.02 if cell == "hex8" else 0.005)
    sides = model.evaluate(u).found[contact].sides
    beyond = sides[1].x[sides[1].status > 0]
    assert (beyond[:, 0] > 4.02).any() and (beyond[:, 1] > 3.02).any() and (beyond[:, 0] < 3.9).any()
    check_tangent(model, contact, u, seed=5)


@pytest.mark.parametrize("options", [{"points": 5}, {"cells": 4}], ids=str)
def test_forces_on_rims_have_no_resultant_and_no_moment(options):
    model, contact = crossed(**options)
    u = pressed(model)
    f = forces_of(model, contact, u)[0].reshape(-1, 3)
    x = model.mesh.displaced(u)
    assert np.abs(f.sum(axis=0)).max() < 1e-12 * np.abs(f).sum()
    assert np.abs(np.cross(x, f).sum(axis=0)).max() < 1e-12 * np.abs(f).sum() * 10.0


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (-1.0, 1.0)], ids=str)
def test_a_point_leaves_over_an_edge_without_a_step_of_its_force(way):
    """A block of one point slides over an edge, or over a corner: the force falls to zero along the rim."""
    plate = uf.mesh.strip(4.0, 3.0, 1.0, (3, 2))
    block = uf.mesh.strip(0.2, 0.2, 0.5, (1, 1)).moved((-0.1, -0.1, 0.75))
    mesh = uf.mesh.together(a=plate, b=block)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    contact = model.sheet_contact("upper of a", "lower of b", name="edge", penalty=1e3, points=1)
    above = np.unique(mesh.connectivity[mesh.faces["lower of b"][:, 0]])
    _ = model.system.pattern
    at_edge = [{1.0: 4.0, -1.0: 0.0, 0.0: 0.6}[way[0]], {1.0: 3.0, -1.0: 0.0, 0.0: 0.6}[way[1]]]
    tractions = []
    for beyond in np.linspace(-0.005, 0.195, 2001):
        u = np.zeros((len(mesh.points), 3))
        u[above] += [at_edge[0] + way[0] * beyond, at_edge[1] + way[1] * beyond, -0.02]
        tractions.append(model.evaluate(u.ravel()).found[contact].sides[1].traction[0])
    size = np.linalg.norm(tractions, axis=1)
    assert size[0] == pytest.approx(20.0) and size[-1] == 0.0
    assert np.linalg.norm(np.diff(tractions, axis=0), axis=1).max() < 0.01 * size[0]


def test_a_curved_edge_has_its_rim_beyond_its_nodes():
    """A parabola whose outermost point lies between its nodes, by more than the radius of the rim."""

    def bulged(X):
        return X + np.column_stack([0.2 * X[:, 0] * (1.0 - (X[:, 1] / 2.2 - 1.0) ** 2), np.zeros((len(X), 2))])

    plate = uf.mesh.strip(4.0, 3.0, 0.05, (1, 1), cell="hex18").transformed(bulged)
    block = uf.mesh.strip(0.02, 0.02, 0.05, (1, 1), cell="hex18").moved((-0.01, 2.19, 0.05))
    mesh = uf.mesh.together(a=plate, b=block)
    model = uf.Model(mesh, "MI9K3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    contact = model.sheet_contact("upper of a", "lower of b", name="edge", penalty=1e3, points=1)
    above = np.unique(mesh.connectivity[mesh.faces["lower of b"][:, 0]])
    _ = model.system.pattern
    size = []
    for beyond in np.linspace(-0.002, 0.028, 601):
        u = np.zeros((len(mesh.points), 3))
        u[above] += [4.8 + beyond, 0.0, -0.005]
        size.append(np.linalg.norm(model.evaluate(u.ravel()).found[contact].sides[1].traction[0]))
    assert size[0] == pytest.approx(5.0) and size[-1] == 0.0
    assert np.abs(np.diff(size)).max() < 0.02 * size[0]


def test_a_plate_that_slides_off_another_loses_its_force_with_its_cells():
    """Plates with the same edges, one moved sideways: the force of the cells falls without steps."""
    lower = uf.mesh.strip(4.0, 2.0, 1.0, (4, 2))
    mesh = uf.mesh.together(a=lower, b=lower.moved((0.0, 0.0, 1.0)))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    contact = model.sheet_contact("upper of a", "lower of b", name="edge", penalty=1e3, cells=3)
    above = np.unique(mesh.connectivity[mesh.faces["lower of b"][:, 0]])
    _ = model.system.pattern
    forces = []
    for way in np.linspace(-0.05, 1.05, 1101):
        u = np.zeros((len(mesh.points), 3))
        u[above] += [way, 0.0, -0.02]
        forces.append(model.evaluate(u.ravel()).found[contact].force)
    forces = np.array(forces)
    assert forces[50, 2] == pytest.approx(-0.02 * 1e3 * 8.0, rel=1e-9)
    assert np.abs(np.diff(forces, axis=0)).max() < 0.02 * 160.0
    assert forces[1050, 2] == pytest.approx(-0.02 * 1e3 * 6.0, rel=0.1)
