"""What the first rank cuts for each rank: all parcels make the model, and none grows with what the others have."""

from __future__ import annotations

import dataclasses
import pickle

import numpy as np
import pytest

import umform as uf
from umform.analysis.ranks import share
from umform.analysis.ranks.outline import Outline
from umform.errors import InvalidValue
from umform.mesh import strip
from umform.model import Body, NodalTerm
from umform.model.supports.ties import MidLine
from umform.model.terms.control import Prescribed
from umform.model.terms.dead_load import Load
from umform.model.terms.pressure import Pressure
from umform.parallel.cutting import Cutting
from umform.problem import load
from umform.problem.templates import template_file

SIZE = 3


def wave(fraction):
    return np.sin(fraction)


class Bed(NodalTerm):
    """Springs of their own stiffness below each node, which remember something."""

    each_node = ("stiffness",)

    def __init__(self, nodes, stiffness):
        super().__init__("bed", nodes, history=2)
        self.stiffness = stiffness

    def respond(self, u, history, at):
        return self.stiffness[:, None] * u, self.stiffness[:, None, None] * np.eye(3), history


def sheet(cells=12, motion=None):
    """All that a share may have: supports, ties, loads, a pressure, contacts, a tool that is driven, a foundation."""
    model = uf.Model(strip(float(cells), 4.0, 1.0, (cells, 4)), material=uf.SVK(E=210e3, nu=0.3))
    model.hinge(lambda x, y, z: (x < 1e-9) & (y < 2.5), "xz")
    end = model.prescribe_midline("x1", "z", "end")
    model.fix(lambda x, y, z: (x < 3.5) & (y < 1e-9), "y")
    model.prescribe(lambda x, y, z: (x > 5.5) & (x < 6.5) & (z > 0), "x", "middle")
    model.loads.body_force((0.0, 0.0, -1.0), "weight")
    model.pressure("lower", "pressure")
    die = model.contact("lower", uf.Cylinder((4.0, 0.0, -10.5), "y", 10.0), penalty=10.0, name="die")
    punch = model.contact("upper", uf.Cylinder((4.0, 0.0, 10.5), "y", 10.0), penalty=10.0, points=3, name="punch")
    stroke = model.drive(punch, "-z", "stroke")
    if motion is not None:
        model.set_motion(die, motion)
    nodes = model.mesh.nodes("lower")
    model.add(Bed(nodes, 1.0 + np.arange(len(nodes))))
    return model, [uf.Move([end, stroke], [0.1, wave], steps=2), uf.Release(stroke)]


def parts(model):
    """Ranks of the cells, one after the other along x."""
    x = model.mesh.points[model.mesh.connectivity].mean(axis=1)[:, 0]
    return np.minimum(x / 4.0, SIZE - 1).astype(np.int32)


def parcels(model):
    cutting = Cutting(model, parts(model), SIZE)
    return [cutting.parcel(rank) for rank in range(SIZE)]


def size_of(value):
    """Bytes of all arrays in something."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    if dataclasses.is_dataclass(value):
        value = list(vars(value).values())
    if isinstance(value, dict):
        value = list(value.values())
    return sum(map(size_of, value)) if isinstance(value, list | tuple) else 0


def pieces(cut, model, kind):
    """Of the parcels the pieces of some things of the model, by kind: a list over the ranks for each of them."""
    kinds = {name: len(getattr(model, name)) for name in ("bodies", "controls", "tools", "contacts")}
    kinds |= {"others": len(model.system.others), "holders": len(model.supports.holders)}
    first = sum(list(kinds.values())[: list(kinds).index(kind)])
    assert len(cut[0].pieces) == sum(kinds.values())
    return [[one.pieces[first + k] for one in cut] for k in range(kinds[kind])]


def test_all_parcels_make_the_model():
    model, _ = sheet()
    model.u = np.random.default_rng(2).normal(size=model.u.size)
    cut = parcels(model)
    np.testing.assert_array_equal(np.sort(np.concatenate([one.cells for one in cut])), np.arange(48))
    owned = np.concatenate([one.nodes[one.owned] for one in cut])
    np.testing.assert_array_equal(np.sort(owned), np.arange(len(model.mesh.points)))
    for rank, one in enumerate(cut):
        assert (parts(model)[one.cells] == rank).all()
        np.testing.assert_array_equal(one.nodes[one.connectivity], model.mesh.connectivity[one.cells])
        np.testing.assert_array_equal(one.points, model.mesh.points[one.nodes])
        dofs = (3 * one.nodes[:, None] + np.arange(3)).ravel()
        np.testing.assert_array_equal(one.fixed, model.supports.fixed[dofs])
        np.testing.assert_array_equal(one.u, model.u[dofs])
        assert one.before == sum(other.own for other in cut[:rank])
    assert sum(one.own for one in cut) == cut[0].count == model.supports.unknown_count
    numbers = np.concatenate([one.numbers for one in cut])
    np.testing.assert_array_equal(np.unique(numbers), np.arange(model.supports.unknown_count))


def test_controls_ties_and_contacts_are_parted_too():
    model, _ = sheet()
    cut = parcels(model)
    for control, mine in zip(model.controls, pieces(cut, model, "controls"), strict=True):
        if isinstance(control, Prescribed | MidLine):
            whole = [3 * one.nodes[dofs // 3] + dofs % 3 for one, dofs in zip(cut, mine, strict=True)]
            np.testing.assert_array_equal(np.unique(np.concatenate(whole)), np.unique(control.dofs))
        elif isinstance(control, Load):
            total = np.zeros_like(model.mesh.points)
            for one, vector in zip(cut, mine, strict=True):
                total[one.nodes] += vector.reshape(-1, 3)
            np.testing.assert_array_equal(total.ravel(), control.vector)
        elif isinstance(control, Pressure):
            whole = np.concatenate(
                [np.c_[one.cells[rows[:, 0]], rows[:, 1]] for one, rows in zip(cut, mine, strict=True)]
            )
            np.testing.assert_array_equal(np.unique(whole, axis=0), np.unique(control.faces, axis=0))
    for contact, mine in zip(model.contacts, pieces(cut, model, "contacts"), strict=True):
        for one, (faces, rows, _) in zip(cut, mine, strict=True):
            np.testing.assert_array_equal(np.c_[one.cells[faces[:, 0]], faces[:, 1]], contact.faces[rows])
        assert sum(len(rows) for _, rows, _ in mine) == len(contact.faces)
    for number, tie in enumerate(model.supports.ties):
        whole = np.concatenate([3 * one.nodes[one.ties[number] // 3] + one.ties[number] % 3 for one in cut])
        np.testing.assert_array_equal(np.unique(whole, axis=0), np.unique(tie.dofs, axis=0))


def test_a_begun_state_goes_along():
    model, _ = sheet()
    model.bodies.only.block.restore(
        model.bodies.only.block.state, np.random.default_rng(3).normal(size=model.bodies.only.block.alpha.shape)
    )
    begun = model.contacts[1].state()["history"]
    begun[..., 0] = np.arange(float(begun[..., 0].size)).reshape(begun[..., 0].shape)
    model.contacts[1].restore({"history": begun})
    cut = parcels(model)
    (bodies,), (_, punch) = pieces(cut, model, "bodies"), pieces(cut, model, "contacts")
    for one, body, (_, facets, contact) in zip(cut, bodies, punch, strict=True):
        rows, history = body["rows"], body["history"]
        np.testing.assert_array_equal(one.cells[body["cells"]], rows)
        np.testing.assert_array_equal(history["history"], model.bodies.only.block.state[rows])
        np.testing.assert_array_equal(history["alpha"], model.bodies.only.block.alpha[rows])
        np.testing.assert_array_equal(contact["history"][:, 0, 0], 9.0 * facets)


@pytest.mark.parametrize("begun", [True, False])
def test_points_with_friction_begin_where_the_part_of_a_rank_lies(monkeypatch, begun):
    class Filled(Exception):
        """The system of a rank needs PETSc."""

    def system(*arguments):
        raise Filled

    monkeypatch.setattr(share, "SharedSystem", system)
    model, _ = sheet()
    ball = uf.Sphere((6.0, 0.0, -10.5), 10.0)
    contact = model.contact("lower", ball, penalty=10.0, points=3, friction=0.1, name="ball")
    model.u = np.random.default_rng(5).normal(size=model.u.size)
    cut = parcels(model)
    assert not contact.has_begun
    if begun:
        contact.begin()
        cut = parcels(model)
    for one, (_, facets, history) in zip(cut, pieces(cut, model, "contacts")[-1], strict=True):
        assert (history is not None) == begun
        outline = Outline.of(model)
        with pytest.raises(Filled):
            share.Share(outline, one, None)
        mine, whole = (part.block.positions.reshape(-1, 9, 3) for part in (outline.contacts[-1], contact))
        np.testing.assert_allclose(mine, whole[facets], atol=1e-12)


def test_each_node_of_a_term_is_on_one_rank_with_what_belongs_to_it():
    model, _ = sheet()
    (bed,) = model.system.others
    bed.history = np.random.default_rng(4).normal(size=bed.history.shape)
    cut = parcels(model)
    (mine,) = pieces(cut, model, "others")
    nodes = np.concatenate([one.nodes[part["nodes"]] for one, part in zip(cut, mine, strict=True)])
    np.testing.assert_array_equal(np.sort(nodes), bed.nodes)
    for one, part in zip(cut, mine, strict=True):
        assert np.isin(part["nodes"], one.owned).all()
        np.testing.assert_array_equal(one.nodes[part["nodes"]], bed.nodes[part["rows"]])
        np.testing.assert_array_equal(part["stiffness"], bed.stiffness[part["rows"]])
        np.testing.assert_array_equal(part["history"], bed.history[part["rows"]])


def test_a_parcel_and_the_outline_know_nothing_of_the_size_of_the_whole():
    """The same four by four cells in the middle of sheets of other sizes: the same bytes, to the last one."""
    small, large = (sheet(cells) for cells in (12, 120))
    assert size_of(parcels(small[0])[1]) == size_of(parcels(large[0])[1]) > 0
    assert size_of(parcels(large[0])[2]) > 10 * size_of(parcels(small[0])[2])
    assert len(pickle.dumps(Outline.of(*small))) == len(pickle.dumps(Outline.of(*large)))


def test_what_chose_the_cells_of_bodies_stays_with_the_first_rank():
    sizes = []
    for columns in (12, 120):
        mesh = strip(float(columns), 4.0, 1.0, (columns, 4))
        left = np.arange(len(mesh.connectivity)) < 24
        rolling = np.tile((1.0, 0.0, 0.0), (24, 1))
        law = uf.SVK(E=210e3, nu=0.3)
        bodies = [
            Body(material=law, cells=left, name="left", rolling=rolling),
            Body(material=law, cells=np.flatnonzero(~left), name="right"),
        ]
        sizes.append(len(pickle.dumps(Outline.of(uf.Model(mesh, bodies=bodies)))))
    assert sizes[0] == sizes[1]


def test_an_outline_is_the_same_on_the_other_side():
    """Each step and tool moves a control of the outline, not of the model; the model is left as it was."""
    model, steps = sheet(motion=wave)
    here = Outline.of(model, steps)
    for outline in (here, pickle.loads(pickle.dumps(here))):
        names = {control.name: control for control in outline.controls}
        assert list(names) == [control.name for control in model.controls]
        assert outline.steps[0].control == [names["end"], names["stroke"]]
        assert outline.steps[0].to[1] is wave
        assert outline.contacts[1].tool is outline.tools[1]
        assert outline.tools[1].ways == [names["stroke"]]
        assert outline.tools[1].ways[0].tool is outline.tools[1]
        assert outline.tools[0].motion is wave
        assert outline.tied == [None, None, names["end"]]
        assert names["stroke"] is not model.controls[-1]
    assert len(model.contacts[0].facets) == 48
    assert model.controls[0].dofs.size


@pytest.mark.parametrize("name", ["air-bending", "cantilever", "free-bending", "own-mesh"])
def test_what_a_deck_describes_can_be_sent(name):
    changes = {"contacts.cylinder.motion": {"time": [0.0, 1.0], "translation": [[0, 0, 0], [0, 0, 2.0]]}}
    problem = load(template_file(name), changes if name == "free-bending" else {}).build("superlu")
    outline = pickle.loads(pickle.dumps(Outline.of(problem.model, problem.steps)))
    assert [contact.name for contact in outline.contacts] == list(problem.contacts)
    for contact, whole in zip(outline.contacts, problem.model.contacts, strict=True):
        assert contact.tool.surface == whole.tool.surface
        if whole.tool.motion is not None:
            np.testing.assert_array_equal(contact.tool.motion(0.5)[0], [0.0, 0.0, 1.0])


def test_a_function_without_a_name_is_refused_with_a_remedy():
    from umform.analysis.ranks.outline import _pickled

    model, steps = sheet(motion=lambda time: np.zeros(3))
    with pytest.raises(InvalidValue, match="cannot be sent") as caught:
        _pickled(Outline.of(model, steps))
    assert "top of a file" in caught.value.remedy
    with pytest.raises(InvalidValue, match="the first rank has no model"):
        _pickled(None)
