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


def start(ranks, *words, timeout=120):
    """Run Python with some words on some ranks, 0 for one process without mpiexec; at the end of the time, fail."""
    mpiexec = ["mpiexec", "--oversubscribe", "-n", str(ranks)] if ranks else []
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}
    command = [*mpiexec, sys.executable, *[str(word) for word in words]]
    env = {**os.environ, **root, "OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg"}
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=timeout)


def run(ranks, *words):
    """The same, for what must go well."""
    done = start(ranks, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    return done


@pytest.fixture(scope="session")
def mpi():
    return SimpleNamespace(start=start, run=run, cases=CASES)


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
