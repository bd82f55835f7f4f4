"""What the docs show runs: blocks of a page in their order, in one folder, sharing their names, as a reader types them.

A block of `python` or `sh` is run, one of `toml` whose first line is a comment with a file name is written there, and
one of `text` shows what the block of `sh` before it prints. `console` shows commands that cannot run in a test.
"""

from __future__ import annotations

import ast
import logging
import math
import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
WITH_BLOCKS = [page for page in PAGES if re.search(r"^```(python|sh)$", page.read_text(), flags=re.M)]
KINDS = {"python", "sh", "toml", "text", "console", "mermaid", ""}


def blocks(page: Path) -> list[tuple[str, str]]:
    """Kind and text of all fenced blocks of a page."""
    return re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(), flags=re.S | re.M)


def shell(command: str, folder: Path, *, bin_folder: Path) -> str:
    """What a block of commands prints; it must end well."""
    environment = {**os.environ, "PATH": f"{bin_folder}{os.pathsep}{os.environ['PATH']}", "COLUMNS": "160"}
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def shown(expected: str, printed: str) -> bool:
    """Whether a line of the page begins a printed one: words alike, numbers within 0.5 % or their digits."""
    wanted = expected.split()
    return any(
        len(line.split()) >= len(wanted) and all(map(_alike, wanted, line.split())) for line in printed.splitlines()
    )


def _alike(word: str, other: str) -> bool:
    try:
        digits = len(word.partition(".")[2])
        return math.isclose(float(word), float(other), rel_tol=5e-3, abs_tol=0.6 * 10**-digits)
    except ValueError:
        return word == other


#: Pages that take longest; other tests run their commands on coarser meshes.
LONG = {ROOT / "docs" / name for name in ("bend-tables.md", "identification.md", "tutorials/9-which-tolerance.md")}
RUN = [pytest.param(page, marks=[pytest.mark.long] * (page in LONG)) for page in WITH_BLOCKS]


#: Warnings that a page speaks of.
SAID = {
    "sweeps.md": "places of tools do not follow the thickness",
    "residual-and-tangent.md": "enhanced parameters are not in equilibrium",
}


@pytest.mark.parametrize("page", RUN, ids=lambda page: str(page.relative_to(ROOT)))
def test_blocks_run_without_warnings(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    bin_folder = tmp_path / "bin"
    bin_folder.mkdir()
    (bin_folder / "umform").write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m umform "$@"\n')
    (bin_folder / "umform").chmod(0o755)
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    names: dict[str, object] = {"__name__": "docs"}
    printed = ""
    for kind, text in blocks(page):
        if kind == "python":
            exec(compile(text, str(page), "exec", dont_inherit=True), names)
        elif kind == "sh":
            printed = shell(text, folder, bin_folder=bin_folder)
        elif kind == "toml" and (name := re.match(r"# (\S+\.toml)\n", text)):
            Path(name[1]).write_text(text)
        elif kind == "text" and printed:
            for line in filter(None, map(str.strip, text.splitlines())):
                assert shown(line, printed), f"{page.name} shows {line!r}, printed was\n{printed}"
    said = SAID.get(page.name, "no warning")
    assert [one.message for one in caplog.records if one.levelno >= logging.WARNING and said not in one.message] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_block_says_what_it_is(page: Path) -> None:
    for kind, text in blocks(page):
        assert kind in KINDS, (page.name, kind)
        assert kind or not re.search(r"^umform \w+", text, flags=re.M), f"{page.name}: commands without a kind: {text}"


@pytest.mark.parametrize("page", WITH_BLOCKS, ids=lambda page: str(page.relative_to(ROOT)))
def test_pages_import_what_is_installed_with_umform_or_name_the_extra(page: Path) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    known = {"umform", "umform_book", *sys.stdlib_module_names, *_names(project["dependencies"])}
    for extra, requirements in project["optional-dependencies"].items():
        if f"umform[{extra}]" in page.read_text():
            known |= _names(requirements)
    code = "\n".join(text for kind, text in blocks(page) if kind == "python")
    imported = {
        (node.module or "" if isinstance(node, ast.ImportFrom) else alias.name).split(".")[0]
        for node in ast.walk(ast.parse(code))
        if isinstance(node, ast.Import | ast.ImportFrom)
        for alias in node.names
    }
    assert imported <= known, imported - known


def _names(requirements: list[str]) -> set[str]:
    """Modules of the packages that are required."""
    packages = (re.match(r"[\w-]+", requirement)[0] for requirement in requirements)
    return {"OCP" if package == "cadquery-ocp-novtk" else package.replace("-", "_") for package in packages}


@pytest.mark.parametrize("script", ["readme_numbers.py", "performance_numbers.py"])
def test_summaries_quote_the_numbers_of_their_pages(script: str) -> None:
    assert subprocess.run([sys.executable, str(ROOT / "tools" / script), "--check"], check=False).returncode == 0


def test_links_between_pages_lead_somewhere() -> None:
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#:]+?)(?:#[^)]*)?\)", page.read_text()):
            assert (page.parent / target).exists(), (page.name, target)
