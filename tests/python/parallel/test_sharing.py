"""What can be known of many ranks without MPI: columns, owners, numbers, options. tests/mpi has the runs."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import umform as uf
from umform.analysis.ranks.run import _outline
from umform.analysis.run import solve
from umform.cli import ranks as of_command
from umform.cli.ranks import split
from umform.errors import InvalidValue, ModelError
from umform.mesh import strip
from umform.parallel.cutting import by_rank
from umform.parallel.numbering import Owners, tied_pairs
from umform.parallel.partition import columns
from umform.ranks import ONE

STEEL = uf.SVK(E=210e3, nu=0.3)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("layers", [1, 3])
def test_cells_on_top_of_each_other_make_a_column(cell, layers):
    mesh = strip(8.0, 3.0, 1.0, (4, 3), cell=cell, layers=layers)
    column = columns(mesh)
    centre = mesh.points[mesh.connectivity[:, :4]].mean(axis=1)
    assert len(np.unique(column)) == 12
    for number in np.unique(column):
        assert np.ptp(centre[column == number, :2], axis=0).max() < 1e-12
        assert (column == number).sum() == layers


def test_the_unknowns_of_a_rank_are_consecutive_and_each_is_numbered_once():
    model = uf.Model(strip(8.0, 3.0, 1.0, (4, 3)), material=STEEL)
    model.hinge("x0", "xz")
    model.prescribe("x1_lower", "z", "end")
    part = (model.mesh.connectivity[:, 0] % 3).astype(np.int32)
    owners = Owners.of(model, by_rank(part, 3))
    numbers = np.concatenate([owners.equation[owners.equation >= 0], owners.tie])
    np.testing.assert_array_equal(np.sort(numbers), np.arange(model.supports.unknown_count))
    assert model.supports.unknown_count == model.system.pattern.n == owners.own.sum()
    pairs = tied_pairs(model)
    assert (owners.equation[pairs] == -1).all()
    ends = np.concatenate([[0], np.cumsum(owners.own)])
    nodes = np.flatnonzero(owners.equation.reshape(-1, 3) >= 0) // 3
    of = np.searchsorted(ends, owners.equation[owners.equation >= 0], side="right") - 1
    np.testing.assert_array_equal(of, owners.node[nodes])
    for rank in range(3):  # a node belongs to a rank that has a cell of it
        mine = np.flatnonzero(owners.node == rank)
        assert np.isin(mine, model.mesh.connectivity[part == rank]).all()


def test_one_rank_is_its_own_sum():
    a, b = np.array([1.0, 2.0]), np.array([3.0, -1.0])
    assert ONE.dot(a, b) == 1.0
    assert ONE.sum(2.5) == ONE.max(2.5) == 2.5
    assert ONE.join(b"state") == b"state"
    ONE.agree(None)
    with pytest.raises(InvalidValue):
        ONE.agree(InvalidValue("no"))


@pytest.mark.parametrize(
    ("words", "own", "petsc"),
    [
        ("deck.toml --solver petsc", "deck.toml --solver petsc", ""),
        ("deck.toml -umform_ksp_type cg -v", "deck.toml -v", "-umform_ksp_type cg"),
        ("-umform_ksp_view deck.toml", "", "-umform_ksp_view deck.toml"),  # it could be a value: the deck comes first
        ("d.toml -umform_ksp_view -umform_ksp_rtol -1e-9", "d.toml", "-umform_ksp_view -umform_ksp_rtol -1e-9"),
        ("deck.toml -umform_ksp_view --out x", "deck.toml --out x", "-umform_ksp_view"),
    ],
)  # fmt: skip
def test_options_of_petsc_are_told_from_those_of_the_command(words, own, petsc):
    assert split(words.split()) == (own.split(), petsc.split())


def test_without_petsc_one_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "petsc4py", None)
    model = uf.Model(strip(8.0, 3.0, 1.0, (4, 3)), material=STEEL)
    model.fix("x0")
    pull = model.prescribe("x1", "x", "pull")
    with pytest.raises(uf.UmformError, match="the solver petsc needs petsc4py and mpi4py") as caught:
        solve(model, uf.Move(pull, 0.1), solver="petsc")
    assert "docs/parallel.md" in caught.value.remedy


def test_without_a_model_one_process_has_nothing_to_solve():
    with pytest.raises(InvalidValue, match="there is no model"):
        solve(None, [])


def test_what_the_ranks_had_is_not_taken_for_a_fresh_state():
    model = uf.Model(strip(8.0, 3.0, 1.0, (4, 3)), material=STEEL)
    model.bodies[0].elsewhere = True
    with pytest.raises(ModelError, match="the history of the elements is not here"):
        model.evaluate(model.u)
    floor = model.contact("lower", uf.Plane((0, 0, -0.5), (0, 0, 1)), penalty=1.0)
    floor.elsewhere = True
    with pytest.raises(ModelError, match="the state of contact tool1 is not here"):
        floor.resultant()


def test_nothing_of_mpi_is_imported_without_being_asked_for():
    code = "import sys, umform, umform.cli, umform.analysis.ranks.run; print({'mpi4py', 'petsc4py'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


AROUND = uf.cylindrical((0.0, 0.0, -20.0), "y")


@pytest.mark.parametrize(
    ("support", "name"),
    [
        (lambda model: model.fix("x1", "r", axes=AROUND, name="roller"), "roller"),
        (lambda model: model.prescribe("x1", "r", "push", axes=AROUND), "push"),
        (lambda model: model.hold_director("x1", "z", name="edge"), "edge"),
    ],
)
def test_supports_that_ranks_cannot_share_are_refused_by_name(support, name):
    model = uf.Model(strip(8.0, 3.0, 1.0, (4, 3)), material=STEEL)
    model.fix("x0")
    support(model)
    with pytest.raises(InvalidValue, match="do not work with the solver petsc") as caught:
        _outline(model, [], ONE)
    assert name in str(caught.value)


def test_sheets_that_touch_are_refused_by_name():
    model = uf.Model(strip(8.0, 3.0, 1.0, (4, 3)), material=STEEL)
    model.self_contact("upper", name="inside")
    model.fix("x0")
    with pytest.raises(InvalidValue, match="sheets that touch cannot be shared with the solver petsc") as caught:
        _outline(model, [], ONE)
    assert caught.value.where == "contact inside"


@pytest.mark.parametrize(
    ("rank", "common", "waits"), [(0, False, []), (1, False, [of_command._PATIENCE]), (1, True, [])]
)
def test_the_first_rank_prints_an_error_before_another_ends_all(rank, common, waits, monkeypatch, capsys):
    """Unless all know of the error: those then wait for each other in MPI."""
    waited = []
    monkeypatch.setenv("OMPI_COMM_WORLD_RANK", str(rank))
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "3")
    monkeypatch.setattr(of_command.time, "sleep", waited.append)
    monkeypatch.setattr(sys, "__stderr__", sys.stderr)
    error = InvalidValue("a deck that is wrong", where="here", value=1)
    error.on_all_ranks = common
    with pytest.raises(InvalidValue), of_command.let_the_first_end_all():
        raise error
    assert waited == waits
    told = "umform: rank 1 of 3 has failed, and ends all: a deck that is wrong"
    assert capsys.readouterr().err.startswith(told) == bool(waits)
