"""Sweeps: a deck run over values of some of its keys, in processes, with one table and one plot of all jobs."""

from umform.sweeps.study import Sweep, sweep

__all__ = ["Sweep", "sweep"]
