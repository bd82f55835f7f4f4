"""Sparse solvers: the protocol and one file per solver."""
