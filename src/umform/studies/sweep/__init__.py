"""Sweeps: run a deck over values of some of its keys, in parallel, with one table and one plot."""

from umform.studies.sweep.study import Sweep, sweep

__all__ = ["Sweep", "sweep"]
