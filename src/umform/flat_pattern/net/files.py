"""The files of a corrected blank, beside its deck: deck, mesh, drawing, table of the edge."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from umform.flat_pattern.net.corrections import NetBlank
from umform.flat_pattern.one_step.files import write_dxf
from umform.io.tables import write_csv
from umform.problem.named_units import length_of


def names(stem: str) -> dict[str, str]:
    """Names of the files by what they hold."""
    return {"deck": f"{stem}.toml", "mesh": f"{stem}.inp", "outline": f"{stem}.dxf", "edge": f"{stem}.csv"}


def write_files(folder: Path, stem: str, found: NetBlank) -> list[Path]:
    """Write deck, outline and table; the mesh is written by the runs.

    Parameters
    ----------
    folder : Path
        That of the deck, so that the files that it names are found.
    stem : str
        Name of the files without their ends.
    found : NetBlank
        The blank.

    Raises
    ------
    FileProblem
        If ezdxf is not installed.
    """
    files = {kind: folder / name for kind, name in names(stem).items()}
    files["deck"].write_text(found.deck.toml(), encoding="utf-8")
    write_dxf(files["outline"], [found.outline[:-1]], length_of(found.deck))
    columns = {"run": np.repeat(np.arange(len(found.runs)), [len(run.distance) for run in found.runs])}
    for heads, part in (
        (("blank_x", "blank_y"), [run.blank.points for run in found.runs]),
        (("x", "y", "z"), [run.formed for run in found.runs]),
    ):
        columns |= dict(zip(heads, np.concatenate(part).T, strict=True))
    write_csv(files["edge"], columns | {"distance": np.concatenate([run.distance for run in found.runs])})
    return list(files.values())
