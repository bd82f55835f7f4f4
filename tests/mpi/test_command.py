"""``umform run`` under mpiexec: files, options of PETSc, and every way to end: one message, no hang."""

from __future__ import annotations

import csv
import os
import shutil
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np
import pytest

from umform.analysis.run.checkpoint import read_checkpoint
from umform.errors import FileProblem
from umform.problem.templates import template_file

UMFORM = ("-m", "umform")
SHORT = ("--set", "mesh.cells=[12, 2]", "--set", "steps.0.increments=4", "--set", "steps.0.to.punch=-3.0")


@pytest.fixture
def deck():
    return template_file("free-bending")


def history(folder):
    with (folder / "history.csv").open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_a_deck_on_two_ranks_writes_the_files_of_one_process(deck, tmp_path, mpi):
    serial, ranks = tmp_path / "serial", tmp_path / "ranks"
    mpi.run(0, *UMFORM, "run", deck, "--out", serial, "--solver", "superlu", *SHORT)
    done = mpi.run(2, *UMFORM, "run", deck, "--out", ranks, "--solver", "petsc", *SHORT)
    assert done.stdout.count("Written to") == done.stdout.count("solver petsc") == 1
    assert {file.name for file in ranks.iterdir()} == {file.name for file in serial.iterdir()}
    one, two = history(serial), history(ranks)
    np.testing.assert_array_equal(one["iterations"], two["iterations"])
    largest = np.abs(one["punch_force"]).max()
    np.testing.assert_allclose(two["punch_force"], one["punch_force"], rtol=0, atol=1e-8 * largest)
    with h5py.File(serial / "fields.vtkhdf") as a, h5py.File(ranks / "fields.vtkhdf") as b:
        for name in ("Points", "Connectivity"):
            np.testing.assert_array_equal(a["VTKHDF"][name][()], b["VTKHDF"][name][()])
        u, v = (file["VTKHDF/PointData/displacement"][()] for file in (a, b))
        np.testing.assert_allclose(v, u, rtol=0, atol=1e-8 * np.abs(u).max())
    assert "degrees of freedom" in (ranks / "report.html").read_text()


def rows(path):
    """Rows of the history in a checkpoint."""
    try:
        return len(read_checkpoint(path)["result"]["history"][0])
    except FileProblem:
        return 0


def wait_for_end(processes):
    """A process that is killed frees its memory first, which on a busy machine may take longer than mpiexec."""
    for process in processes:
        stat = Path(f"/proc/{process}/stat")
        with suppress(OSError):  # it is gone
            for _ in range(1000):
                if ") Z " in stat.read_text():
                    break
                time.sleep(0.01)


def test_a_run_that_was_killed_goes_on_from_its_checkpoint_on_another_number_of_ranks(deck, tmp_path, mpi):
    whole, out = tmp_path / "whole", tmp_path / "out"
    words = ("run", deck, "--solver", "petsc", *SHORT, "--set", "steps.0.increments=25")
    mpi.run(2, *UMFORM, *words, "--out", whole)
    running = mpi.begin(2, *UMFORM, *words, "--out", out, "--every", "0")
    kept = out / "checkpoint.h5"
    for _ in range(6000):
        if rows(kept) > 2 or running.poll() is not None:
            break
        time.sleep(0.01)
    children = Path(f"/proc/{running.pid}/task/{running.pid}/children").read_text().split()
    for child in children:  # the ranks; a signal to mpiexec alone lets them go on for a while
        os.kill(int(child), signal.SIGKILL)
    running.wait(60)
    wait_for_end(children)
    assert rows(kept) > 2
    assert not (out / "history.csv").exists()
    done = mpi.run(3, *UMFORM, "resume", kept)
    assert done.stdout.count("Written to") == 1
    one, two = history(whole), history(out)
    np.testing.assert_array_equal(one["iterations"], two["iterations"])
    largest = np.abs(one["punch_force"]).max()
    np.testing.assert_allclose(two["punch_force"], one["punch_force"], rtol=0, atol=1e-8 * largest)


@pytest.mark.parametrize("ranks", [0, 2])
def test_options_of_petsc_come_in_by_their_prefix(ranks, deck, tmp_path, mpi):
    """Conjugate gradients and multigrid, which gets the rigid-body modes, instead of MUMPS: the same forces."""
    words = (
        *UMFORM,
        "run",
        deck,
        "--solver",
        "petsc",
        "--set",
        "steps.0.increments=2",
        "--set",
        "steps.0.to.punch=-0.01",
    )
    mpi.run(0, *words, "--out", tmp_path / "mumps")
    iterative = ("-umform_ksp_type", "cg", "-umform_pc_type", "gamg", "-umform_ksp_view", "-umform_ksp_rtol", "1e-12")
    done = mpi.run(ranks, *words, "--out", tmp_path / "cg", *iterative)
    assert "type: cg" in done.stdout
    assert "type: gamg" in done.stdout
    assert "has attached near null space" in done.stdout
    direct, found = history(tmp_path / "mumps"), history(tmp_path / "cg")
    largest = np.abs(direct["punch_force"]).max()
    np.testing.assert_allclose(found["punch_force"][:3], direct["punch_force"][:3], rtol=0, atol=1e-6 * largest)


def test_no_convergence_ends_all_with_one_message_and_whole_files(deck, tmp_path, mpi):
    few = ("--set", "solution.max_iterations=4", "--set", "steps.0.cuts=1")
    done = mpi.start(3, *UMFORM, "run", deck, "--out", tmp_path, "--solver", "petsc", *SHORT, *few)
    assert done.returncode == 1
    assert done.stderr.count("Newton's method did not converge") == 1
    assert done.stderr.count("the results so far are written") == 1
    assert len(history(tmp_path)["punch"]) >= 1
    with h5py.File(tmp_path / "fields.vtkhdf") as file:
        assert file["VTKHDF/Steps"].attrs["NSteps"] >= 1


@pytest.mark.parametrize("ranks", [2, 3])
def test_a_rank_that_fails_alone_ends_all_with_one_message(ranks, tmp_path, mpi):
    done = mpi.start(ranks, mpi.cases, "fail", "petsc", tmp_path, "cut")
    assert done.returncode != 0
    message = (
        f"umform: rank 1 of {ranks} has failed, and ends all: ZeroDivisionError: a function of the user on one rank"
    )
    assert done.stderr.count(message) == 1
    assert "Traceback" not in done.stderr


def test_a_wrong_deck_is_told_once(deck, tmp_path, mpi):
    done = mpi.start(2, *UMFORM, "run", deck, "--solver", "petsc", "--out", tmp_path, "--set", "mesh.cells=[0, 1]")
    assert done.returncode == 1
    assert done.stderr.count("umform: it should be greater than or equal to 1") == 1


def test_the_first_rank_alone_reads_the_mesh(tmp_path, mpi):
    """The other rank has the deck, but not the file that it names."""
    own = template_file("own-mesh")
    for name in ("first", "other"):
        (tmp_path / name).mkdir()
        shutil.copy(own, tmp_path / name / "deck.toml")
    shutil.copy(own.with_name("sheet.inp"), tmp_path / "first")
    short = ("--set", "steps.0.increments=2", "--set", "steps.1.increments=1", "--set", "steps.0.to.down=-1.0")
    words = ("--out", tmp_path / "out", "--solver", "petsc", *short)
    first, other = ((*UMFORM, "run", tmp_path / name / "deck.toml", *words) for name in ("first", "other"))
    mpi.run(1, *first, ":", "-n", 1, sys.executable, *other)
    alone = mpi.start(0, *other, "--overwrite")
    assert alone.returncode == 1
    assert "sheet.inp" in alone.stderr
    np.testing.assert_array_equal(history(tmp_path / "out")["time"][:4], [0.0, 0.5, 1.0, 2.0])


def test_a_folder_that_cannot_be_written_ends_all(deck, tmp_path, mpi):
    (tmp_path / "file").write_text("in the way")
    done = mpi.start(2, *UMFORM, "run", deck, "--solver", "petsc", "--out", tmp_path / "file" / "out", *SHORT)
    assert done.returncode != 0
    assert done.stderr.count("umform: rank 0 of 2 has failed, and ends all") == 1


def test_a_solver_of_one_process_refuses_ranks(deck, tmp_path, mpi):
    done = mpi.start(2, *UMFORM, "run", deck, "--solver", "superlu", "--out", tmp_path)
    assert done.returncode == 1
    assert done.stderr.count("each process would do the whole run") == 1


def test_more_ranks_than_the_mesh_has_parts_for_are_refused(deck, tmp_path, mpi):
    cells = ("--set", "mesh.cells=[2, 1]")
    done = mpi.start(3, *UMFORM, "run", deck, "--solver", "petsc", "--out", tmp_path, *SHORT, *cells)
    assert done.returncode == 1
    assert done.stderr.count("umform: a rank has no cell") == 1


def test_an_arc_is_refused(tmp_path, mpi):
    done = mpi.start(2, *UMFORM, "run", template_file("hinged-roof"), "--solver", "petsc", "--out", tmp_path)
    assert done.returncode == 1
    assert done.stderr.count("umform: an arc cannot be followed with the solver petsc") == 1
