"""Tables on the screen: whole numbers at any width; of steps no row that never changes."""

from io import StringIO
from types import SimpleNamespace

import pytest
from rich.console import Console

from umform.cli import outcome_screen
from umform.cli.step_table import step_rows, step_tables


def history(steps):
    """A history with three controls: a tool, one that is never used, a load."""
    rows = [
        {"step": step, "time": float(step), "stroke": 1.5 * step, "stroke_force": 12034.0 * step, "hold": 0.0}
        | {"hold_force": 7.0, "load": 5.0 * step, "load_force": 5.0 * step, "iterations": 3 if step else 0}
        for step in range(steps + 1)
    ]
    controls = [SimpleNamespace(name="stroke"), SimpleNamespace(name="hold"), SimpleNamespace(name="load")]
    return SimpleNamespace(rows=rows, model=SimpleNamespace(controls=controls))


def printed(steps, width):
    console = Console(width=width, record=True, force_terminal=False, color_system=None, file=StringIO())
    for table in step_tables(history(steps), width):
        console.print(table, crop=False, no_wrap=True, overflow="ignore")
    return console.export_text()


def test_quantities_are_rows_and_constant_ones_are_left_out():
    rows = step_rows(history(2))
    assert rows[0] == ["step", "1", "2"]
    assert [row[0] for row in rows] == ["step", "time", "increments", "iterations", "stroke", "stroke_force", "load"]
    assert rows[-2] == ["stroke_force", "12034", "24068"]


def test_no_number_is_cut_at_any_width():
    for width in (20, 40, 79, 200):
        text = printed(9, width)
        assert "…" not in text
        assert all(str(12034 * step) in text.split() for step in range(1, 10))
        if width > 20:
            assert max(map(len, text.splitlines())) <= width


@pytest.mark.parametrize("width", [40, 79, 200])
def test_no_number_of_a_wide_table_is_cut(width, monkeypatch):
    screen = Console(width=width, record=True, file=StringIO())
    monkeypatch.setattr(outcome_screen, "console", lambda: screen)
    values = [f"{number + 0.25:+.6g}" for number in range(12)]
    names = [f"parameter {number}" for number in range(12)]
    outcome_screen.print_table([["quantity", *names, "unit"], ["largest force", *values, "N mm"]], "Changes")
    text = screen.export_text()
    assert "…" not in text and set(values) <= set(text.split()) and text.count("Changes") == 1
    assert max(map(len, text.splitlines())) <= width
