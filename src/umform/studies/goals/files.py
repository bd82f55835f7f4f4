"""Files of a compensation: runs, deck, tools, page."""

from __future__ import annotations

import importlib.util
import logging
from collections.abc import Mapping
from pathlib import Path

from umform.errors import InvalidValue
from umform.io.atomic import write_text
from umform.problem import Problem
from umform.studies.goals.shapes import Tools
from umform.surfaces import Box, write_tool
from umform.surfaces.tool import Placed, Tool

log = logging.getLogger("umform")

#: Files of all tools.
DRAWING, SOLIDS = "compensated.dxf", "compensated.step"
#: Modules that write them.
_MODULES = {DRAWING: "ezdxf", SOLIDS: "OCP"}
#: Largest distance of triangles from a tool, relative to the diagonal of the box.
_CHORD = 1e-4


def write_tools(folder: Path, found: Tools, unit: str) -> list[Path]:
    """Write tools in a unit: sections that one drawing can show as DXF, solids as STEP, all others as STL.

    What a missing extra would write is left out, with a message.
    """
    exact = {name: tool for name, tool in found.tools.items() if _is_exact(tool)}
    files, missing = [], []
    for name, kept in ((DRAWING, _of_one_drawing(exact)), (SOLIDS, exact)):
        if kept and importlib.util.find_spec(_MODULES[name]) is None:
            missing.append(name)
        elif kept:
            files.append(write_tool(kept, folder / name, found.box, unit=unit))
    if missing:
        log.warning(f'{" and ".join(missing)} not written: pip install "umform[cad]"')
    chord = _CHORD * sum((high - low) ** 2 for low, high in zip(*found.box, strict=True)) ** 0.5
    for name, tool in found.tools.items():
        if name not in exact:
            files.append(write_tool(tool, folder / f"compensated-{name}.stl", found.box, chord))
    return files


def write_deck(path: Path, problem: Problem, wanted: str) -> Path:
    """Write the deck of a problem with what was found for a wanted result, complete or not at all."""
    own = f"{problem.source.name} for {wanted}; files that it names are looked for beside it."
    text = problem.toml(remarks=[] if problem.source.made else [own])
    return write_text(path, text)


def _is_exact(tool: Tool) -> bool:
    inner = tool.tool if isinstance(tool, Placed) else tool
    return isinstance(inner, Box) or tool.section() is not None


def _of_one_drawing(tools: Mapping[str, Tool]) -> Mapping[str, Tool]:
    """The tools; none if they have no common plane."""
    from umform.surfaces.sections import sections

    try:
        sections(tools)
    except InvalidValue:
        return {}
    return tools
