"""Parts to unfold: STEP files in the folder of the bench by name, with what was read of them."""

from __future__ import annotations

import json
import re
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from umform.bench.gone import gone
from umform.bench.shelf import file_of
from umform.bench.subprocess_json import json_of_module
from umform.errors import InvalidValue, UmformError
from umform.io.atomic import write_text

#: Bytes of a part, parts that are kept, and seconds that the reading of one may take.
LONGEST_PART, MOST_PARTS, _LONGEST_READING = 20_000_000, 200, 60.0
#: Name of their folder.
PARTS = "parts"
_NAME = re.compile(r"\w[\w +.,°-]{0,59}\.(step|stp)", re.IGNORECASE)


@dataclass(frozen=True)
class Parts:
    """The parts of a bench.

    Parameters
    ----------
    folder : Path
        Folder of the bench; the parts are in ``parts``.
    """

    folder: Path

    def path_of(self, name: str) -> Path:
        """The STEP file of a part.

        Raises
        ------
        InvalidValue
            If no part can have this name.
        """
        if not _NAME.fullmatch(name):
            raise InvalidValue(
                "this name is not valid for a part",
                where="part",
                value=name[:80],
                cause="it does not end in .step or .stp, is too long, or has characters that a file name cannot have",
                remedy="the STEP file of one part, with 1 to 60 letters, digits, blanks, dots and dashes",
            )
        return self.folder / PARTS / name

    def view_of(self, name: str) -> Path:
        """The page with the 3D view of a part."""
        place = self.path_of(name)
        return place.with_name(f"{place.name}.html")

    def row(self, name: str) -> dict[str, Any]:
        """Name, thickness and bends of a part.

        Raises
        ------
        InvalidValue
            If there is none.
        """
        try:
            found: dict[str, Any] = json.loads(_record_of(self.path_of(name)).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise gone("there is no such part", "part", name, "choose another one, or upload the file again") from error
        return {"name": name, **found}

    def rows(self) -> list[dict[str, Any]]:
        """All parts."""
        found = []
        for path in sorted((self.folder / PARTS).glob("*.json"))[:MOST_PARTS]:
            try:
                found.append(self.row(path.name.removesuffix(".json")))
            except UmformError:
                continue  # a damaged record: the file can be uploaded again
        return found

    def add(self, name: str, content: str) -> dict[str, Any]:
        """Read a part in a separate process and keep it; one of the same name is replaced.

        Parameters
        ----------
        name : str
            Name of the file.
        content : str
            The STEP file, as base64.

        Returns
        -------
        dict
            Its row, or ``problem``.
        """
        place = self.path_of(name)
        place.parent.mkdir(parents=True, exist_ok=True)
        if len(list(place.parent.glob("*.json"))) >= MOST_PARTS and not place.exists():
            raise InvalidValue(f"there are {MOST_PARTS} parts already", where="part", remedy="delete some")
        with tempfile.TemporaryDirectory(prefix="umform-bench-") as folder:
            path = Path(folder) / name
            path.write_bytes(file_of(content, LONGEST_PART, "part", "a STEP file", "an assembly, or an empty file"))
            view = path.with_name("view.html")
            arguments = ["umform.bench.read_part", str(path), str(view)]
            found: dict[str, Any] = json_of_module(arguments, _LONGEST_READING, "the reading of the part")
            if "problem" in found:
                return found
            shutil.move(view, self.view_of(name))
            shutil.move(path, place)
        write_text(_record_of(place), json.dumps(found))
        return self.row(name)

    def remove(self, name: str) -> None:
        """Delete a part; jobs have their own copies."""
        place = self.path_of(name)
        _record_of(place).unlink(missing_ok=True)
        self.view_of(name).unlink(missing_ok=True)
        place.unlink(missing_ok=True)


def _record_of(place: Path) -> Path:
    return place.with_name(f"{place.name}.json")
