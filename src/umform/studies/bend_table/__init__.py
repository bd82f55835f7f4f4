"""Bend tables for CAD systems: every number is from a run, and is kept in a store."""

from umform.studies.bend_table.stored import StoredBend, bend, bend_key, bends
from umform.studies.bend_table.table import BendTable, Setup, Tabled, bend_table, setups

__all__ = ["BendTable", "Setup", "StoredBend", "Tabled", "bend", "bend_key", "bend_table", "bends", "setups"]
