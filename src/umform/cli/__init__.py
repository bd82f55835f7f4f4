"""The command line, one command a file; what fails says so in a few lines."""

from umform.cli import bend, check, demo, elements, new, plot, resume, run, verify, view
from umform.cli.root import app

__all__ = ["app", "bend", "check", "demo", "elements", "main", "new", "plot", "resume", "run", "verify", "view"]


def main() -> None:
    """Start the command line."""
    app()
