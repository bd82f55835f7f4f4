"""One model on many ranks of MPI, solved through PETSc. docs/parallel.md

Each rank has a share of the model: its own cells with their history, contact facets and pressures, in numbers of its
own. Displacements are the same on all ranks that have a node; forces are shares that PETSc sums up.
petsc4py and mpi4py are imported when a run asks for them, and not before.
"""
