"""Drawn punches and dies: drawings in the folder of the bench by name, with the sections read from them."""

from __future__ import annotations

import base64
import binascii
import json
import re
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from umform.bench.gone import gone
from umform.bench.subprocess_json import json_of_module
from umform.errors import InvalidValue, UmformError
from umform.io.atomic import write_text
from umform.processes.air_bending.drawn_tools import DrawnDie, DrawnPunch
from umform.surfaces import Profile
from umform.surfaces.segments import Arc, Line, Segment

KINDS = ("punch", "die")
#: Bytes of a drawing, tools on the shelf, and seconds that the reading of a drawing may take.
LONGEST_DRAWING, MOST_TOOLS, _LONGEST_READING = 6_000_000, 200, 60.0
_TOO_LARGE = "a drawing of the whole machine, or an empty file"
_NAME = re.compile(r"\w[\w +.,°-]{0,39}")


@dataclass(frozen=True)
class Shelf:
    """The tools in a folder: that of the bench, or that of a job, which has its own copies.

    Parameters
    ----------
    folder : Path
        Folder of ``tools/punch`` and ``tools/die``.
    """

    folder: Path

    def path_of(self, kind: str, name: str) -> Path:
        """File of the section of a tool.

        Raises
        ------
        InvalidValue
            If no tool can have this name.
        """
        if kind not in KINDS or not _NAME.fullmatch(name) or name.strip(" .") != name:
            raise InvalidValue(
                "this name is not valid for a tool",
                where="name",
                value=name[:60],
                cause="it is empty, too long, or has characters that a file name cannot have",
                remedy="1 to 40 letters, digits, blanks, dots and dashes",
            )
        return self.folder / "tools" / kind / f"{name}.json"

    def tool(self, kind: str, name: str) -> DrawnPunch | DrawnDie:
        """A tool by its name.

        Raises
        ------
        InvalidValue
            If there is none.
        """
        try:
            text = self.path_of(kind, name).read_text(encoding="utf-8")
        except OSError as error:
            raise gone(
                "there is no such drawn tool", kind, name, "choose another one, or upload the drawing again"
            ) from error
        return _tool(kind, text)

    def add(self, kind: str, name: str, layer: str, drawing: str) -> dict[str, Any]:
        """Read a drawing in a separate process and store it under a name; a tool of the same name is replaced.

        Parameters
        ----------
        kind : str
            "punch" or "die".
        name, layer : str
            Name of the tool; the layer with its section, empty for the whole drawing.
        drawing : str
            The DXF file, as base64.

        Returns
        -------
        dict
            Its row of `rows`, or ``problem`` and ``layers``.
        """
        place = self.path_of(kind, name)
        place.parent.mkdir(parents=True, exist_ok=True)
        if len(list(place.parent.glob("*.json"))) >= MOST_TOOLS and not place.exists():
            raise InvalidValue(f"there are {MOST_TOOLS} tools already", where="name", remedy="delete some")
        with tempfile.TemporaryDirectory(prefix="umform-bench-") as folder:
            path = Path(folder) / "drawing.dxf"
            path.write_bytes(file_of(drawing, LONGEST_DRAWING, "drawing", "a drawing", _TOO_LARGE))
            arguments = ["umform.bench.read_tool", kind, str(path), layer]
            found: dict[str, Any] = json_of_module(arguments, _LONGEST_READING, "the reading of the drawing")
            if "problem" in found:
                return found
            shutil.move(path, place.with_suffix(".dxf"))
        write_text(place, json.dumps(found | {"layer": layer}))
        return _row(kind, place)

    def rows(self) -> list[dict[str, Any]]:
        """Kind, name and sizes of all tools."""
        return [
            _row(kind, path)
            for kind in KINDS
            for path in sorted((self.folder / "tools" / kind).glob("*.json"))[:MOST_TOOLS]
        ]

    def remove(self, kind: str, name: str) -> None:
        """Delete a tool; jobs have their own copies."""
        place = self.path_of(kind, name)
        place.unlink(missing_ok=True)
        place.with_suffix(".dxf").unlink(missing_ok=True)

    def copy_to(self, folder: Path, tools: Mapping[str, str | None]) -> None:
        """Copy the tools of a job into its folder."""
        for kind, name in tools.items():
            if name is not None:
                other = Shelf(folder).path_of(kind, name)
                other.parent.mkdir(parents=True)
                shutil.copyfile(self.path_of(kind, name), other)


def profile_record(profile: Profile) -> dict[str, Any]:
    """A section as JSON, exact to the last bit."""
    rows = [
        [*one.start, *one.end, *((*one.centre, int(one.clockwise)) if isinstance(one, Arc) else ())]
        for one in profile.segments
    ]
    return {"segments": [[float(value) for value in row] for row in rows], "closed": profile.closed}


def _segment(row: list[float]) -> Segment:
    if len(row) == 4:
        return Line((row[0], row[1]), (row[2], row[3]))
    return Arc((row[0], row[1]), (row[2], row[3]), (row[4], row[5]), bool(row[6]))


@lru_cache(maxsize=64)
def _tool(kind: str, text: str) -> DrawnPunch | DrawnDie:
    """The tool of a file; cached, because the check for self-intersection takes some milliseconds."""
    try:
        content = json.loads(text)
        profile = Profile([_segment(row) for row in content["segments"]], content["closed"])
    except (ValueError, KeyError, TypeError, IndexError) as error:
        raise UmformError(
            "the file of a drawn tool is broken",
            where=kind,
            cause=str(error),
            remedy="delete the tool, and read its drawing again",
        ) from error
    return DrawnPunch.of(profile, kind) if kind == "punch" else DrawnDie.of(profile, kind)


def _row(kind: str, place: Path) -> dict[str, Any]:
    row: dict[str, Any] = {"kind": kind, "name": place.stem}
    try:
        text = place.read_text(encoding="utf-8")
        content, tool = json.loads(text), _tool(kind, text)
    except (OSError, ValueError, UmformError):
        return row | {"broken": True}
    row |= {"layer": content.get("layer", ""), "unit": content.get("unit", ""), "layers": content.get("layers", [])}
    sizes = {"angle": tool.angle, "radius": tool.radius}
    if isinstance(tool, DrawnDie):
        sizes |= {"opening": tool.opening, "depth": tool.depth}
    return row | {name: round(value, 4) for name, value in sizes.items()}


def file_of(coded: str, most: int, where: str, what: str, cause: str) -> bytes:
    """The content of a file of a request.

    Raises
    ------
    InvalidValue
        If it is not base64, empty, or too large.
    """
    try:
        content = base64.b64decode(coded, validate=True)
    except (binascii.Error, ValueError) as error:
        raise InvalidValue(
            "a file is sent as base64", where=where, cause=str(error), remedy="choose the file again"
        ) from error
    if not content or len(content) > most:
        raise InvalidValue(
            f"{what} has 1 to {most} bytes here",
            where=where,
            value=len(content),
            cause=cause,
            remedy="save the section alone as DXF" if where == "drawing" else "export one sheet-metal part",
        )
    return content
