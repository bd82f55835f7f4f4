"""In a Jupyter kernel: figures as the last expression of a cell, progress, errors without frames of umform."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import umform as uf
from umform.plotting import Plot
from umform.progress import NotebookBars, progress_bar

SETUP = """
import umform as uf
model = uf.Model(uf.mesh.strip(10.0, 2.0, 0.5, (10, 1)), material=uf.SVK(E=210e3, nu=0.3))
clamp = model.fix("x0")
tip = model.prescribe("x1", "x", name="tip")
result = uf.solve(model, uf.Move(tip, 0.01, steps=2))
"""
PROGRESS = """
import time
from umform.progress import progress_bar
with progress_bar() as tick:
    for part in range(8):
        tick("<move>", part / 8, "tip 1")
        time.sleep(0.1)
"""
CELLS = {
    "setup": SETUP,
    "figure": "result.plot('tip', 'tip_force')",
    "inline": "import matplotlib.pyplot as plt\nresult.plot('tip', 'tip_force')",
    "model": "model",
    "progress": PROGRESS,
    "failure": "def press(way):\n    return uf.solve(model, uf.Move(tip, way, steps=1, cuts=1))\npress(-9.99)",
    "verbose": "%xmode Verbose\nmodel.fix('nowhere')",
}


@pytest.fixture(scope="module")
def outputs(tmp_path_factory):
    """Outputs of cells that one kernel has run."""
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS.values()])
    notebook.metadata.kernelspec = {"name": "python3", "display_name": "Python 3", "language": "python"}
    client = nbclient.NotebookClient(
        notebook,
        allow_errors=True,
        timeout=120,
        resources={"metadata": {"path": str(tmp_path_factory.mktemp("cells"))}},
    )
    updates = []
    handle = client.process_message
    client.process_message = lambda message, cell, number: updates.append(message) or handle(message, cell, number)
    client.execute()
    return {name: cell.outputs for name, cell in zip(CELLS, notebook.cells, strict=True)} | {"messages": updates}


@pytest.mark.parametrize("cell", ["figure", "inline"])
def test_a_figure_is_shown_once(outputs, cell):
    (shown,) = outputs[cell]
    assert shown.output_type == "execute_result" and len(shown.data["image/png"]) > 5000


def test_a_model_is_shown_as_a_table(outputs):
    (shown,) = outputs["model"]
    assert shown.data["text/plain"].startswith("Model(") and "<table>" in shown.data["text/html"]


def test_a_short_run_shows_nothing_and_a_longer_one_bars_that_go(outputs):
    assert outputs["setup"] == []
    (shown,) = outputs["progress"]
    assert shown.data["text/html"] == ""
    sent = [m["content"]["data"]["text/html"] for m in outputs["messages"] if "display_data" in m["msg_type"]]
    moving = [float(found[1]) for text in sent if (found := re.search(r"value='([\d.]+)'", text))]
    assert 1 < len(moving) < 5 and moving == sorted(moving) and moving[0] >= 0.5
    assert all("&lt;move&gt;" in text and "tip 1" in text for text in sent[:-1])


def test_an_error_is_the_lines_of_the_user_and_its_message(outputs):
    (error,) = outputs["failure"]
    lines = "\n".join(error.traceback).splitlines()
    assert lines[0] == "line 3 of a cell: press(-9.99)"
    assert lines[1] == "line 2 of a cell: return uf.solve(model, uf.Move(tip, way, steps=1, cuts=1))"
    assert lines[2].startswith("NoConvergence: Newton's method did not converge") and "remedy:" in lines[6]
    assert len(lines) < 10
    verbose = "\n".join(outputs["verbose"][-1].traceback)
    assert "supports.py" in verbose and "UnknownSet" in verbose


def test_without_ipython_there_is_no_bar_and_no_short_traceback(capsys, monkeypatch):
    with progress_bar() as tick:
        assert not isinstance(tick, NotebookBars)
    monkeypatch.delitem(sys.modules, "IPython", raising=False)
    with pytest.raises(uf.UmformError) as raised:
        uf.Perfect(-1.0)
    own, *message, last = raised.value._render_traceback_()
    assert own.endswith("uf.Perfect(-1.0)") and "InvalidValue" in message[0] and "%tb" in last
    assert capsys.readouterr() == ("", "")


def test_all_plots_of_the_package_are_shown_in_notebooks():
    made = [
        path.name
        for path in Path(uf.__file__).parent.rglob("*.py")
        if re.search(r"= Figure\(", path.read_text(encoding="utf-8"))
    ]
    assert made == ["rendering.py"]  # writes files only
    assert issubclass(Plot, Figure)
