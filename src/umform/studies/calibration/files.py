"""The files of a calibration: deck block, Python, constants, pictures."""

from __future__ import annotations

import math
from pathlib import Path

from umform.io.staging import staging
from umform.io.tables import write_csv
from umform.studies.calibration.calibrate import Calibration
from umform.studies.calibration.code import deck_block, function_block, modulus_block, python_code
from umform.studies.calibration.pictures import pictures

_PICTURES = ("directions", "locus", "modulus", "tension", "cycles")
FILES = ("metal.toml", "metal.py", "constants.csv", *(f"{name}.{end}" for name in _PICTURES for end in ("png", "svg")))


def texts(found: Calibration) -> tuple[str, str]:
    """Block of a deck, and Python."""
    if found.law is None:
        blocks = [function_block(found.yield_function)] if "yield function" in found.fits else []
        blocks += [modulus_block(found.fits["modulus"].law)] if "modulus" in found.fits else []
        return "".join(deck for deck, _ in blocks), "".join(python for _, python in blocks)
    return deck_block(found.law), python_code(found.law)


def write_files(out: str | Path, found: Calibration) -> list[Path]:
    """Write the results to a folder; the files appear together.

    Parameters
    ----------
    out : str or Path
        Folder for metal.toml, metal.py, constants.csv and a picture of each kind of measurement as .png and .svg.
    found : Calibration
        The result.
    """
    from umform.plotting import house_style, save

    with staging(out, FILES) as stage:
        here = stage.waiting
        deck, python = texts(found)
        (here / "metal.toml").write_text(deck, encoding="utf-8")
        (here / "metal.py").write_text(python, encoding="utf-8")
        table = [
            (name, constant, value, fit.deviations[constant])
            for name, fit in found.fits.items()
            for constant, value in fit.constants.items()
        ]
        columns = list(zip(*table, strict=True)) or [()] * 4
        names = ("fit", "constant", "value", "standard_error")
        errors = [None if math.isinf(error) else error for error in columns[3]]
        write_csv(here / "constants.csv", dict(zip(names, [*columns[:3], errors], strict=True)))
        with house_style():
            for name, figure in pictures(found):
                for ending in (".png", ".svg"):
                    save(figure, here / (name + ending))
        return stage.commit(FILES)
