"""The table of what was measured, printed at the end of a run."""

from __future__ import annotations

from collections.abc import Callable

import pytest

_ROWS = pytest.StashKey[list[tuple[str, ...]]]()
_HEADER = ("case", "element", "quantity", "reference", "umform", "deviation")


def pytest_configure(config: pytest.Config) -> None:
    config.stash[_ROWS] = []


@pytest.fixture
def book(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Enter a measured value into the table: ``book(case, element, quantity, reference, found)``."""

    def enter(case: str, element: str, quantity: str, reference: float, found: float) -> None:
        deviation = f"{100 * (found / reference - 1):+.2f} %"
        request.config.stash[_ROWS].append((case, element, quantity, f"{reference:.5g}", f"{found:.5g}", deviation))

    return enter


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    rows = sorted(config.stash[_ROWS])
    if not rows:
        return
    terminalreporter.section("measured against references")
    widths = [max(len(row[k]) for row in [_HEADER, *rows]) for k in range(len(_HEADER))]
    for row in [_HEADER, *rows]:
        terminalreporter.write_line("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)))
