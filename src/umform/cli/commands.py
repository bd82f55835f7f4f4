"""All commands: the application with those of umform, and those of other packages."""

from umform.cli import bead, bench, bend, check, demo, draw, elements, hem, metals, new, plot, resume, run, sweep, view
from umform.cli.root import app

__all__ = [
    "app",
    "bead",
    "bench",
    "bend",
    "check",
    "demo",
    "draw",
    "elements",
    "hem",
    "metals",
    "new",
    "plot",
    "resume",
    "run",
    "sweep",
    "view",
]
