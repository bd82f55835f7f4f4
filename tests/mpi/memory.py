"""What Python allocates on each rank in a whole run of sheets of which all ranks but the first have the same few cells.

``mpiexec -n 3 python memory.py`` prints one line of JSON on the first rank. The allocations are counted, so they are
the same in each run; those of the kernels, which know the share alone, are not among them.
"""

from __future__ import annotations

import gc
import json
import tempfile
import tracemalloc
from pathlib import Path

import numpy as np
from cases import Foam

import umform as uf
from umform.analysis.ranks import run
from umform.mesh import strip
from umform.model import Body
from umform.parallel.mpi_ranks import world

#: Columns of cells that a rank after the first has.
MINE, WIDE = 10, 5


def sheet(columns):
    """A sheet of two bodies, with contact, ties, a load, a pressure and a foundation."""
    mesh, law = strip(float(columns), 4.0, 1.0, (columns, WIDE)), uf.SVK(E=210e3, nu=0.3)
    odd = np.arange(len(mesh.connectivity)) % 2 == 1
    bodies = [Body(material=law, cells=odd, name="odd"), Body(material=law, cells=~odd, name="even")]
    model = uf.Model(mesh, bodies=bodies)
    model.fix("x0", "xz")
    model.hinge("x1", "z")
    end = model.prescribe("y0", "y", "end")
    model.loads.body_force((0.0, 0.0, -0.01), "weight")
    model.pressure("upper", "pressure")
    nodes = mesh.nodes("lower")
    model.add(Foam(nodes, np.full(len(nodes), 0.1), limit=1.0, slope=1.0))
    model.contact("lower", uf.Cylinder((4.0, 0.0, -10.6), "y", 10.0), penalty=10.0)
    return model, [uf.Move(end, 0.01, steps=2)]


def in_the_middle(mesh, ranks):
    """Rank of each cell: the others have some columns each, the first one all the rest."""
    if mesh is None:
        return None
    x = mesh.points[mesh.connectivity].mean(axis=1)[:, 0]
    number = (x - 1.0) // MINE  # one column at the edge is the first rank's
    return np.where((number >= 0) & (number < ranks.size - 1), number + 1, 0).astype(np.int32)


def measured(columns, folder):
    """Cells here, bytes that a run allocates at most, and what its result keeps."""
    ranks = world()
    model, steps = sheet(columns) if ranks.rank == 0 else (None, [])
    gc.collect()
    tracemalloc.start()
    result = uf.solve(model, steps, solver="petsc", checkpoint=Path(folder) / "run.chk.h5", every=0.0)
    peak = tracemalloc.get_traced_memory()[1]
    gc.collect()
    kept = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    cells = len(result.model.system.cells) if ranks.rank > 0 else 0  # the first rank gets its whole model back
    of_all = {name: ranks.comm.gather(value) for name, value in (("cells", cells), ("peak", peak), ("kept", kept))}
    return {"whole": columns * WIDE, **of_all}


def main():
    run.partition = in_the_middle  # a library would part evenly
    with tempfile.TemporaryDirectory() as folder:
        measured(60, folder)  # what is imported on the way
        answer = [measured(columns, folder) for columns in (60, 600)]
    if world().rank == 0:
        print(json.dumps(answer))


if __name__ == "__main__":
    main()
