"""Bend tables for CAD systems: every number is from a run, and is kept in a store."""

from umform.studies.bend_table.correct import Corrected, correct
from umform.studies.bend_table.formats import FORMATS, write_table
from umform.studies.bend_table.stored import StoredBend, bend, bend_key, bends, stored_bends
from umform.studies.bend_table.table import BendTable, Between, Setup, Tabled, bend_table, setups

__all__ = [
    "FORMATS",
    "BendTable",
    "Between",
    "Corrected",
    "Setup",
    "StoredBend",
    "Tabled",
    "bend",
    "bend_key",
    "bend_table",
    "bends",
    "correct",
    "setups",
    "stored_bends",
    "write_table",
]
