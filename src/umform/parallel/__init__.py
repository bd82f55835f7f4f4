"""One model on many ranks of MPI, solved through PETSc. docs/parallel.md

Each rank has a part of the model: its cells with their history, contact facets and pressures, in local numbering.
Displacements at a node are the same on all ranks; forces are partial sums that PETSc adds. petsc4py and mpi4py are
imported only for such a run.
"""
