"""Processes of MPI that the tests start; ``make test-mpi`` runs them, see docs/parallel.md."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("petsc4py", reason="the tests of many ranks need PETSc: make test-mpi")

CASES = Path(__file__).parent / "cases.py"


def command(ranks, *words):
    """Python with some words on some ranks, 0 for one process without mpiexec; and its environment."""
    mpiexec = ["mpiexec", "--oversubscribe", "-n", str(ranks)] if ranks else []
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}
    env = {**os.environ, **root, "OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg"}
    return [*mpiexec, sys.executable, *[str(word) for word in words]], env


def start(ranks, *words, timeout=800):
    """Run to the end; when the time is up, fail."""
    words, env = command(ranks, *words)
    return subprocess.run(words, env=env, capture_output=True, text=True, timeout=timeout)


def begin(ranks, *words):
    """Start, and leave it running."""
    words, env = command(ranks, *words)
    return subprocess.Popen(words, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def run(ranks, *words):
    """The same, for what must go well."""
    done = start(ranks, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    return done


@pytest.fixture(scope="session")
def mpi():
    return SimpleNamespace(start=start, begin=begin, run=run, cases=CASES)


@pytest.fixture(scope="session")
def found(tmp_path_factory):
    """Results of all cases: ``found(ranks, case)``, 0 for the serial run; each number of ranks is started once."""
    folders = {}

    def of(ranks, case):
        if ranks not in folders:
            folders[ranks] = tmp_path_factory.mktemp(f"ranks{ranks}")
            run(ranks, CASES, "solve", "petsc" if ranks else "superlu", folders[ranks])
        return np.load(folders[ranks] / f"{case}.npz")

    return of
