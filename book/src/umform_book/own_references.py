"""References that are our own fine meshes: ``python -m umform_book.own_references FOLDER`` makes their files.

It takes some minutes; the book reads the files that are stored.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform_book.nonlinear import pinched_cylinder as elastic
from umform_book.nonlinear.tracing import LOAD, trace
from umform_book.plastic import pinched_cylinder as plastic
from umform_book.variants import with_tying

Floats = NDArray[np.float64]


def diaphragms(finest: int = 96, coarser: int = 64) -> dict[str, Floats]:
    """First point of the curves of the elastic pinched cylinder, and two coarser meshes for its uncertainty."""
    fractions = np.array([0.05])
    quietly = partial(solve, progress=False)
    columns: dict[str, Floats] = {LOAD: fractions}
    for name, divisions, end in (
        ("MI9K3DEAS", finest, ""),
        ("MI9K3DEAS", coarser, f"_MI9K3DEAS_{coarser}"),
        ("EAS3DEAS", coarser, f"_EAS3DEAS_{coarser}"),
    ):
        curve = trace(elastic.build(with_tying(name), divisions), fractions, quietly)
        columns |= {f"{probe}{end}": values[1:] for probe, values in curve.items() if probe != LOAD}
    return columns


def dented(divisions: int = 48, increments: int = 60) -> dict[str, Floats]:
    """Force over displacement of the plastic pinched cylinder."""
    model, control = plastic.eighth(with_tying("MI9K3DEAS"), divisions)
    result = solve(model, Move(control, -plastic.DEPTH, steps=increments), frames=0, progress=False)
    way = np.arange(0.0, plastic.DEPTH + 1.0, 5.0)
    return {"displacement": way, "force": np.interp(way, -result["way"], -4.0 * result["way_force"])}


def csv_text(head: Sequence[str], columns: Mapping[str, Floats]) -> str:
    """A file of reference values."""
    rows = [",".join(f"{value:.6g}" for value in row) for row in zip(*columns.values(), strict=True)]
    return "\n".join([*(f"# {line}" for line in head), ",".join(columns), *rows]) + "\n"


def _make_files(folder: Path) -> None:
    made = "Made by `python -m umform_book.own_references FOLDER`."
    head = [
        "Own computation, for a quick look only: MI9K3DEAS with E_33 tied on an eighth with 96 x 96 intervals between",
        f"nodes; for its uncertainty, MI9K3DEAS and EAS3DEAS with E_33 tied on 64 x 64 intervals. {made}",
    ]
    (folder / "pinched_cylinder_first_point.csv").write_text(csv_text(head, diaphragms()), encoding="utf-8")
    head = [f"Own computation: MI9K3DEAS with E_33 tied, 48 x 48 intervals on an eighth, 60 increments. {made}"]
    (folder / "pinched_cylinder_plastic.csv").write_text(csv_text(head, dented()), encoding="utf-8")


if __name__ == "__main__":
    _make_files(Path(sys.argv[1]))
