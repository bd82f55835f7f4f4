"""How the couplings of sheets fill the factors: by none, by a few, by those of a search, counted.

python benchmarks/couplings_of_sheets.py --page docs/performance-contact.md   # or: make touch
"""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, triu
from scipy.spatial import cKDTree

import pages
import umform as uf
from sheets_that_touch import CASES, pairs_of
from umform.solvers import Pattern
from umform.solvers.multifrontal import Multifrontal

Numbers = NDArray[np.integer]


def entries(model: uf.Model) -> csr_array:
    """Where the tangent has entries, above and below the diagonal."""
    pattern = model.system.pattern
    upper = csr_array((np.ones(len(pattern.indices)), pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    return csr_array(upper + triu(upper, 1).T) if pattern.symmetric else upper


def joined(matrix: csr_array, model: uf.Model, pairs: Numbers) -> csr_array:
    """The same with entries for more pairs of nodes, shape (k, 2)."""
    equation = np.full(model.u.size, -1)
    equation[model.system.restrict(np.arange(model.u.size, dtype=float)).astype(int)] = np.arange(matrix.shape[0])
    dofs = equation.reshape(-1, 3)[np.concatenate([pairs, pairs[:, ::-1]])]
    row, column = np.repeat(dofs[:, 0], 3, axis=1).ravel(), np.tile(dofs[:, 1], (1, 3)).ravel()
    free = (row >= 0) & (column >= 0)
    return csr_array(matrix + csr_array((np.ones(free.sum()), (row[free], column[free])), shape=matrix.shape))


def filled(matrix: csr_array) -> int:
    """Entries of the factors of a matrix with these entries, whose diagonal prevails."""
    matrix.sum_duplicates()
    matrix.data[:] = 1e-3
    matrix.setdiag(10.0)
    matrix.sort_indices()
    solver = Multifrontal()
    rows, columns = matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32)
    solver.analyse(Pattern(matrix.shape[0], rows, columns, False))
    return solver.factor(matrix.data).fill


def across(name: str, model: uf.Model) -> Numbers:
    """Each node of the first sheet, or of the lower flank, with the nearest one of the other, if they are to touch."""
    contact = model.system.sheet_contacts[0]
    nodes = [np.unique(facets) for facets in contact.facets]
    if name == "fold":
        z = model.mesh.points[nodes[0], 2]
        nodes = [nodes[0][z < z.mean()], nodes[0][z >= z.mean()]]
    x = contact.points_at(model.u).reshape(-1, 3)
    distance, near = cKDTree(x[nodes[1]]).query(x[nodes[0]])
    touch = distance <= contact._size
    return np.column_stack([nodes[0], nodes[1][near]])[touch]


def counted(name: str, side: int) -> list[dict[str, str]]:
    """At the end of a run: no couplings, a few, and those of searches."""
    model, steps = CASES[name](side)
    uf.solve(model, steps, progress=False, frames=0)
    contact = model.system.sheet_contacts[0]
    of_run = pairs_of(contact.couples())
    for one in contact.passes:
        one.search(model.u, 0.0, 0.0)
    of_place = pairs_of([one.couplings() for one in contact.passes])
    matrix, facets = entries(CASES[name](side, touching=False)[0]), sum(map(len, contact.facets))
    alone, rows = filled(matrix.copy()), []
    kinds = {
        "none": np.empty((0, 2), dtype=np.int32),
        "nearest node across": across(name, model),
        "a search that holds here only": of_place,
        "the last search of the run": of_run,
    }
    for kind, pairs in kinds.items():
        whole = joined(matrix, model, pairs)
        rows.append(
            {
                "case": name,
                "elements": f"{len(model.mesh.connectivity)}",
                "couplings": kind,
                "of a facet": f"{len(pairs) / facets:.1f}",
                "entries": f"{1e-6 * whole.nnz:.2f} M",
                "fill": f"{1e-6 * (fill := filled(whole)):.2f} M",
                "to none": f"{fill / alone:.1f}",
            }
        )
        print(" | ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
    return rows


def main() -> None:
    """Count, print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", choices=CASES, nargs="*", default=list(CASES))
    parser.add_argument("--side", type=int, default=25, help="square root of the elements")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the table into this page")
    given = parser.parse_args()
    logging.getLogger("umform").addHandler(logging.NullHandler())
    uf.set_threads(1)
    rows = [row for name in given.case for row in counted(name, given.side)]
    if given.page:
        pages.put(given.page, "couplings", pages.table(rows, left=(0, 1)))


if __name__ == "__main__":
    main()
