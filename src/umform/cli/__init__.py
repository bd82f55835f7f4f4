"""The command line, one command a file; what fails says so in a few lines."""

from umform.cli import demo, elements, verify
from umform.cli.root import app

__all__ = ["app", "demo", "elements", "main", "verify"]


def main() -> None:
    """Start the command line."""
    app()
