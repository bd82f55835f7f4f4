"""Check that the sources are ready to be tagged: `check_release.py [--tag vX.Y.Z]`; with a tag, the addresses too."""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
#: Ends the host of an address that is still to be set (RFC 2606).
PLACEHOLDER = ".example/"


def problems(root: Path = ROOT, tag: str = "") -> Iterator[str]:
    """What does not agree: versions, dates, headings of the changelog, and for a tag its name and the addresses.

    Parameters
    ----------
    root : Path
        Folder of the sources.
    tag : str
        Name of the tag; empty: none yet.
    """
    version = _found(r'^__version__ = "(.+)"', root / "src/umform/__init__.py")
    book = tomllib.loads((root / "book/pyproject.toml").read_text(encoding="utf-8"))["project"]
    if book["version"] != version or f"umform=={version}" not in book["dependencies"]:
        yield f"book/pyproject.toml: version {book['version']}, {book['dependencies'][0]}; umform is {version}"
    cited = _found(r"^version: (.+)", root / "CITATION.cff")
    if cited != version:
        yield f"CITATION.cff: version {cited}; umform is {version}"
    date = _found(rf"^## \[{re.escape(version)}\] - (\d\d\d\d-\d\d-\d\d)$", root / "CHANGELOG.md")
    if not date:
        yield f"CHANGELOG.md: no heading '## [{version}] - YYYY-MM-DD'"
    elif date != _found(r"^date-released: (.+)", root / "CITATION.cff"):
        yield f"CITATION.cff: date-released is not {date}, the date of {version} in CHANGELOG.md"
    if tag:
        yield from _of_tag(root, tag, version)


def _of_tag(root: Path, tag: str, version: str) -> Iterator[str]:
    if tag != f"v{version}":
        yield f"the tag is {tag}, the version {version}: its tag is v{version}"
    heading = (root / "CHANGELOG.md").read_text(encoding="utf-8").partition("## [Unreleased]")[2].partition("\n## ")[0]
    if heading.strip():
        yield f"CHANGELOG.md: there are entries under Unreleased; move them under {version}"
    urls = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]["urls"]
    for name, url in urls.items():
        if PLACEHOLDER in f"{url}/":
            yield f"pyproject.toml: the address {name} = {url} is a placeholder; set that of the forge"


def _found(pattern: str, path: Path) -> str:
    """The group of a pattern in a file, or nothing."""
    match = re.search(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
    return match[1] if match else ""


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tag", default="", help="name of the tag")
    found = list(problems(tag=parser.parse_args().tag))
    print(*found, sep="\n", end="\n" if found else "")
    sys.exit(bool(found))
