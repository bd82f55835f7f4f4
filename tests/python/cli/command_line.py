"""The command line in the process of a test."""

from __future__ import annotations

from typer.testing import CliRunner

from umform import cli


def umform(*words):
    """The result of a command: its exit code and what it has printed."""
    return CliRunner().invoke(cli.app, [str(word) for word in words])
