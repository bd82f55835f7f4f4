"""Two sheets that touch are cut: what stays keeps its friction, whose tractions go with the other sheet."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.run import solve
from umform.errors import InvalidValue
from umform.history_variables import named
from umform.model.contact.kept_history import KeptContact
from umform.model.transfer.rigid_motion import RigidMotion


def contact_of(model, **options):
    return model.sheet_contact("upper of a", "lower of b", name="stack", friction=0.15, **{"points": 2} | options)


@pytest.fixture(scope="module")
def bent():
    """Two strips of other meshes, pressed on each other and bent together, slipping; and their contact."""
    lower = uf.mesh.strip(20.0, 2.0, 1.0, (10, 1))
    upper = uf.mesh.strip(20.0, 2.0, 0.8, (13, 1)).moved((0.0, 0.0, 0.9))
    material = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(160.0, 500.0))
    model = uf.Model(uf.mesh.together(a=lower, b=upper), material=material)
    contact = contact_of(model)
    model.fix("x0 of a")
    model.fix("x0 of b")
    pressures = [model.pressure("lower of a", "below"), model.pressure("upper of b", "above")]
    end = model.prescribe("x1 of b", "z", "end")
    solve(model, [uf.Move(pressures, [2.0, 2.0], steps=1), uf.Move(end, -3.0, steps=4)])
    return model, contact


def cut(model, **options):
    """The part up to x = 14.9, and its contact."""
    part = uf.Trim([(14.9, -1.0), (14.9, 3.0)], formed=False).of(model)
    return part, contact_of(part.model, **options)


def test_several_sheets_are_cut_along_elements(bent):
    model, _ = bent
    part, _ = cut(model)
    assert len(part.mesh.connectivity) == 7 + 10
    assert "several sheets" in str(part)
    removed = np.setdiff1d(np.arange(23), part.cells)
    assert (model.mesh.points[model.mesh.connectivity[removed]].mean(axis=1)[:, 0] > 14.9).all()


def test_points_whose_facets_stay_keep_their_tractions(bent):
    model, before = bent
    part, contact = cut(model)
    assert part.keep_friction(contact) == 7 + 10
    found = part.model.evaluate(part.model.system.x).found[contact]
    kept = slipping = 0
    on_cut = part.mesh.nodes("cut")
    at_cut = [np.flatnonzero(np.isin(facets, on_cut).any(axis=1)) for facets in contact.facets]
    for side, (now, then) in enumerate(zip(found.sides, before.found.sides, strict=True)):
        stays = np.repeat(np.isin(before.sides[side][:, 0], part.cells), 4)
        foot = then.facet[stays]
        there = (foot >= 0) & np.isin(before.sides[1 - side][foot, 0], part.cells)
        inside = there & ~np.isin(now.facet, at_cut[1 - side])  # where normals of nodes are means of the same facets
        np.testing.assert_allclose(now.traction[inside], then.traction[stays][inside], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(now.traction[there], then.traction[stays][there], rtol=2e-3, atol=1e-9)
        np.testing.assert_array_equal(now.facet[there], foot[there])
        lost, pressure = now.traction[~there], now.pressure[~there] * (now.status[~there] > 0)
        np.testing.assert_allclose(lost, pressure[:, None] * np.nan_to_num(now.normal[~there]), atol=1e-9)
        kept, slipping = kept + there.sum(), slipping + (then.status[stays][there] == 2).sum()
    assert kept > 50 and slipping > 20
    fresh = cut(model)
    plain = fresh[0].model.evaluate(fresh[0].model.system.x).found[fresh[1]]
    along = [np.abs(one.sides[0].traction[:, 0]).max() for one in (found, plain)]
    assert along[1] < 0.5 * along[0]  # what a stage without it begins with


def test_points_whose_facet_was_cut_off_keep_their_work_and_nothing_else(bent):
    model, before = bent
    part, contact = cut(model)
    was = KeptContact.of(before).left(part.cells, part.same)
    part.keep_friction(contact)
    then, now = (
        named(history, contact.history_variables)
        for history in (was.history, contact.state()["history"].reshape(was.history.shape))
    )
    lost = (then["facet"][..., 0] > 0) & (was.feet[..., 0] < 0)
    assert lost.any() and np.abs(then["traction"][lost]).max() > 0.0 and then["stored"][lost].max() > 0.0
    for name, values in now.items():
        if name not in ("slip", "friction work", "contact work"):
            assert not values[lost].any(), name
    np.testing.assert_allclose(now["friction work"][lost], then["friction work"][lost] + then["stored"][lost])
    np.testing.assert_allclose(now["contact work"][lost], then["contact work"][lost] - then["contact energy"][lost])


def test_sheets_that_stay_are_in_the_equilibrium_of_the_run_before(bent):
    """Far from the cut nothing is unbalanced, and slip goes on from where it was."""
    model, _ = bent
    part, contact = cut(model)
    part.keep_friction(contact)
    part.model.fix("x0 of a", here=True)
    part.model.fix("x0 of b", here=True)
    for name, faces in (("below", "lower of a"), ("above", "upper of b")):
        part.model.pressure(faces, name).value = 2.0
    evaluation = part.model.evaluate(part.model.system.x)
    free = part.model.system.restrict(evaluation.residual)
    nodes = part.mesh.points[:, 0] < 10.0
    residual = np.zeros(part.model.u.size)
    residual[part.model.system.free] = free
    assert np.abs(residual.reshape(-1, 3)[nodes]).max() < 1e-5 * np.sqrt(evaluation.force_scale)
    unbalanced = part.model.unbalanced("cut")
    result = solve(part.model, uf.Move(unbalanced, 0.0, steps=3))
    assert result["stack_friction_work"][0] == pytest.approx(contact.found.sum("friction_work"), rel=0.5)
    assert result["stack_active"][-1] > 20


@pytest.mark.parametrize("other", [{"points": 3}, {"points": None, "cells": 2}])
def test_other_points_are_refused(bent, other):
    part, contact = cut(bent[0], **other)
    with pytest.raises(InvalidValue, match="has the points and the law of the one before"):
        part.keep_friction(contact)


def test_decks_keep_it_too(bent, tmp_path):
    """Through the file of a state."""
    from umform.problem.previous_operation import Before, write_state

    model, before = bent
    write_state(model, tmp_path / "state.h5", {})
    kept = Before(deck="press.toml", state="state.h5", keep=["stack"]).kept(tmp_path)["stack"]
    straight = KeptContact.of(before)
    for one, other in ((kept.faces, straight.faces), (kept.history, straight.history), (kept.feet, straight.feet)):
        np.testing.assert_array_equal(one, other)
    contact = contact_of(uf.Model(model.mesh, material=uf.SVK(E=1.0, nu=0.0)))
    assert kept.put(contact) == 23
    np.testing.assert_array_equal(contact.state()["history"], before.state()["history"])


def test_friction_goes_with_a_part_that_is_placed_elsewhere(bent):
    """A motion of both sheets as one body is no way of one along the other."""
    model, before = bent
    works = []
    for turn in np.eye(3), np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]):
        motion = RigidMotion(turn, np.array([5.0, 3.0, -7.0]))
        there = uf.Model(model.mesh, material=uf.SVK(E=1.0, nu=0.0))
        contact = contact_of(there)
        there.u[:] = motion.displacement(model.mesh.points, model.u)
        there.evaluate(there.u)
        KeptContact.of(before).moved((motion.rotation, motion.shift)).put(contact)
        works.append(there.evaluate(there.u).found[contact].sum("friction_work"))
    assert works[1] == pytest.approx(works[0], rel=1e-12)
