r"""Equations of the theory: numbers by ``\tag``, a label each, and MathJax from a package instead of a network."""

from __future__ import annotations

import re
import shutil
from importlib.util import find_spec
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

TAG = re.compile(r"\\tag\{(\d+\.\d+)\}")
#: What a page loads: TeX in, HTML and CSS out, and the fonts.
PARTS = ("tex-chtml-full.js", "output/chtml/fonts/woff-v2")
OPTIONS = {"options": {"enableMenu": False}, "tex": {"tags": "none"}}  # the parts of the menu are not there


def mark(app: Sphinx, doctree: nodes.document) -> None:
    r"""Give each equation with a ``\tag`` a label, and leave it as it stands: ``split`` knows no ``\tag``."""
    labels = app.env.get_domain("std").anonlabels
    for node in doctree.findall(nodes.math_block):
        text = node.astext().strip()
        for number in TAG.findall(text):
            anchor = f"eq-{number.replace('.', '-')}"
            node["ids"].append(anchor)
            labels[f"eq-{number}"] = app.env.docname, anchor
        node.children = [nodes.Text(rf"\[{text}\]")]
        node["no-wrap"] = node["nowrap"] = True


def copy_mathjax(app: Sphinx, error: Exception | None) -> None:
    """Put what pages load beside them."""
    if error or app.builder.format != "html":
        return
    source = Path(find_spec("sphinx-mathjax-offline").origin).parent / "static" / "mathjax"
    target = Path(app.outdir, "_static", "mathjax")
    for part in PARTS:
        copy = shutil.copytree if (source / part).is_dir() else shutil.copy2
        (target / part).parent.mkdir(parents=True, exist_ok=True)
        if not (target / part).exists():
            copy(source / part, target / part)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.config.mathjax_path = "mathjax/tex-chtml-full.js"
    app.config.mathjax3_config = OPTIONS
    app.connect("doctree-read", mark)
    app.connect("build-finished", copy_mathjax)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
