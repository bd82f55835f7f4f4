"""Staggered heights: the stretch of a bend under tension, mild bends, exactness of each column, states by height."""

import numpy as np
import pytest

import umform as uf
from umform import _core
from umform.elements import thickness_rule
from umform.elements.staggered import default_points, phases, section_rule
from umform.mesh import strip
from umform.mesh.fitted.sheet import Sheet
from umform.model.transfer.transfer import Weights
from umform_book.metals import HARDENING
from umform_book.plastic.pulled_section import ElementSection, FibreSection

SURFACES = [(2, 2), (3, 3), (2, 1), (3, 2), (3, 1), (1, 1), (4, 4)]
STEEL = HARDENING["isotropic"]
#: Of a wide sheet of this steel.
YIELD_FORCE = 2.0 / np.sqrt(3.0) * 141.6


@pytest.mark.parametrize("surface", SURFACES)
def test_each_column_is_exact_for_the_elastic_stiffness(surface):
    t, w = thickness_rule(default_points(surface), "staggered", surface)
    assert t.shape == w.shape == (surface[0] * surface[1], default_points(surface))
    assert (np.diff(t, axis=1) > 0.0).all()
    assert (w > 0.0).all()
    assert np.abs(t).max() < 1.0
    np.testing.assert_array_equal(t, -t[:, ::-1])
    np.testing.assert_array_equal(w, w[:, ::-1])
    np.testing.assert_allclose(w.sum(axis=1), 2.0, rtol=1e-14)
    np.testing.assert_allclose((w * t**2).sum(axis=1), 2.0 / 3.0, rtol=1e-14)


@pytest.mark.parametrize("surface", [(2, 2), (3, 3), (2, 1), (3, 2), (3, 1)])
def test_columns_share_no_heights_with_their_neighbours(surface):
    """In a row or a column of the element they fill the cells of the section, each with a part as its Gauss weight."""
    at = phases(surface).reshape(surface[::-1])
    for of, count in ((at, surface[0]), (at.T, surface[1])):
        parts = 0.5 * _core.gauss(count)[1]
        if surface == (2, 2):
            continue
        for row in of:
            order = np.argsort(row)
            ends = 0.5 * parts[order]
            gaps = np.diff(np.concatenate([row[order], row[order][:1] + 1.0]))
            np.testing.assert_allclose(gaps, ends + np.roll(ends, -1), atol=1e-14)
    if surface == (2, 2):
        np.testing.assert_allclose(np.sort(at.ravel()), [0.125, 0.375, 0.625, 0.875])


@pytest.mark.parametrize(("surface", "worst"), [((2, 2), 0.03), ((3, 1), 0.03), ((2, 1), 0.03), ((1, 1), 0.12)])
def test_mild_bends_keep_their_permanent_curvature(surface, worst):
    """At every curvature from 1.1 times the yield moment on. A single column has 20 points only. eq. (2.49)"""
    k = np.linspace(1.12, 25.0, 4000)
    exact = k - (1.5 - 0.5 / k**2)
    t, w = section_rule(default_points(surface), surface)
    found = k - 1.5 * np.clip(np.outer(k, t), -1.0, 1.0) @ (w * t)
    assert np.abs(found / exact - 1.0).max() < worst


CASES = [("ANS3DEAS", {}), ("EAS3DEAS", {}), ("BEND8", {}), ("MI9K3DEAS", {}), ("BEND18", {})]
FLAT = [("ANS3DEAS", {"plane_strain": True}), ("BEND18", {"plane_strain": True})]


@pytest.fixture(scope="module")
def fibres():
    return bent(FibreSection(STEEL, 400))


def bent(section):
    """Bend to R/h = 10 under 0.3 of the yield force, and back."""
    section.bend(0.0, 0.3 * YIELD_FORCE, 2)
    section.bend(0.1, 0.3 * YIELD_FORCE, 20)
    stretch = section.stretch - 1.0
    section.bend(0.0, 0.3 * YIELD_FORCE, 20)
    return np.array([stretch, section.stretch - 1.0, 1.0 - section.thickness])


@pytest.mark.parametrize(("name", "options"), CASES + FLAT)
def test_stretch_and_thinning_of_a_bend_under_tension(fibres, name, options):
    assert np.abs(bent(ElementSection(name, STEEL, **options)) / fibres - 1.0).max() < 0.03


def test_the_graded_points_miss_the_neutral_fibre(fibres):
    found = bent(ElementSection("ANS3DEAS", STEEL, thickness_points=18, thickness_rule="graded"))
    assert (found / fibres - 1.0).min() > 0.1


def test_while_a_sheet_is_bent_the_distance_of_its_faces_is_the_root_mean_square_of_the_stretches_of_the_fibres():
    fibres, element = FibreSection(STEEL, 400), ElementSection("ANS3DEAS", STEEL)
    for section in (fibres, element):
        section.bend(0.0, 0.3 * YIELD_FORCE, 2)
        section.bend(0.2, 0.3 * YIELD_FORCE, 20)
    square = float(np.sqrt((1.0 + 2.0 * fibres.E33).mean()))
    assert square - fibres.thickness == pytest.approx(1.5e-3, rel=0.02)
    assert element.thickness == pytest.approx(square, abs=2e-4)


@pytest.mark.parametrize("name", ["ANS3DEAS", "BEND18"])
@pytest.mark.parametrize("turns", [1, 2, 3])
def test_another_numbering_of_the_element_gives_the_same_within_the_error_of_the_rule(name, turns):
    as_it_is, turned = (bent(ElementSection(name, STEEL, turns=k)) for k in (0, turns))
    assert np.abs(turned / as_it_is - 1.0).max() < 0.02


@pytest.mark.parametrize("name", ["ANS3DEAS", "EAS3DEAS", "MI9K3DEAS", "BEND18"])
def test_elastic_forces_of_a_distorted_element_are_exact(name):
    """Bending and stretch of a flat element whose sides are not parallel: the same as with Gauss points."""
    mesh = strip(2.0, 1.0, 0.3, (1, 1), cell=uf.elements.element(name).cell)
    x, y, z = mesh.points.T
    mesh = uf.Mesh(np.stack([x + 0.15 * x * y, y - 0.2 * x * y, z], axis=1), {mesh.cell: mesh.connectivity})
    u = 1e-6 * np.stack([x * z + 0.3 * x, 0.4 * y * z - 0.1 * y, -0.5 * x**2 - 0.2 * y**2 - 0.2 * z], axis=1).ravel()
    law = uf.J2(E=210e3, nu=0.3, hardening=uf.Perfect(1e9))
    K = []
    for rule in ({}, {"thickness_points": 12, "thickness_rule": "gauss"}):
        K.append(uf.Model(mesh, name, material=law, **rule).bodies.only.block.element(0, u))
    np.testing.assert_allclose(K[0][0], K[1][0], rtol=0.0, atol=1e-9 * np.abs(K[1][0]).max())
    np.testing.assert_allclose(K[0][1], K[1][1], rtol=0.0, atol=1e-9 * np.abs(K[1][1]).max())


def test_the_complete_order_holds_at_each_column():
    """The thickness stress is one number over a column, also where parts of it flow. eq. (2.46)"""
    section = ElementSection("ANS3DEAS", STEEL)
    section.bend(0.02, 30.0, 10)
    at = uf.fields.body_fields(section.body, section.displacement())
    columns = (at.S[0, :, 2] * at.volume[0]).reshape(-1, 4) / section.body.through[1].T
    np.testing.assert_allclose(columns, np.broadcast_to(columns.mean(axis=0), columns.shape), atol=1e-7)
    assert np.ptp(at.S[0, :, 0]) > 141.6


def test_fields_are_read_by_height():
    mesh = strip(2.0, 1.0, 0.5, (2, 1))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.J2(E=210e3, nu=0.3, hardening=uf.Perfect(1e9)))
    u = np.zeros_like(mesh.points)
    x, _, z = mesh.points.T
    u[:, 0] = 1e-7 * x * (z - z.mean())
    at = uf.fields.body_fields(model.bodies.only, u.ravel())
    for height, strain in (("top", 0.25), ("bottom", -0.25), (0.0, 0.0), (0.5, 0.125), (-0.999, -0.24975)):
        found = at.at_height(at.E, height)
        assert found.shape == (2, 4, 6)
        np.testing.assert_allclose(found[..., 0], 1e-7 * strain, atol=1e-12)
    square = (at.heights**2).T.ravel() * np.ones((2, 1))
    for height in (-0.85, -0.31, 0.02, 0.47, 0.8):
        np.testing.assert_allclose(at.at_height(square, height)[1], [np.interp(height, t, t**2) for t in at.heights])
    with pytest.raises(uf.errors.InvalidValue, match="bottom, top or a number"):
        at.at_height(at.E, "middle")
    with pytest.raises(uf.errors.InvalidValue, match="bottom, top or a number"):
        at.at_height(at.E, None)
    for wrong in (at.E[:, :4], at.E[:1], uf.fields.cell_fields(model)["stress_cauchy"], None):
        for ask in (at.cell_average, lambda values: at.at_height(values, 0.0)):
            with pytest.raises(uf.errors.InvalidValue, match=r"shape \(cells, points, ...\)"):
                ask(wrong)


def test_a_state_moves_to_other_columns_by_height():
    mesh = strip(2.0, 1.0, 1.0, (2, 1))
    sheet = Sheet.of(mesh)
    x = mesh.points[sheet.nodes[:, 0], :2]
    new = np.array([[[0.2, 0.1], [1.7, 0.3], [1.5, 0.9], [0.4, 0.8]]])
    t, _ = thickness_rule(12, "staggered")
    weights = Weights.between(sheet, x, np.arange(2), new, (2, 2), t)
    of_points = t.T.ravel()
    moved = weights.mean(np.stack([of_points, of_points]))
    inside = np.abs(of_points) <= np.abs(t[:, -1]).min()
    np.testing.assert_allclose(moved[0, inside], of_points[inside], atol=1e-14)
    assert np.abs(moved[0] - of_points).max() < 0.06  # beyond the last point: as in it
