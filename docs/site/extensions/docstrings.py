"""Docstrings in the site: a picture of the subject, and equations and pages that they cite as links."""

from __future__ import annotations

import re
import sys

from sphinx.application import Sphinx

from umform.model.terms.term import Term

#: Names that every term has; `state` is a method of terms, and one of models with another meaning.
TERM = {name for name in vars(Term) if not name.startswith("_")} - {"name"}

#: What shows a public name best.
PICTURES = {
    "umform.Model": ("free_bending.png", "Force of a strip bent over a cylinder, by elements and contact points"),
    "umform.model.tools.tool.Tool": ("press_brake.png", "Section of a press brake: die, punch and sheet"),
    "umform.model.contact.Contact": ("cells.png", "Forces of contact at points and over cells"),
    "umform.J2": ("flow_curves.png", "Flow curves of sheet metals"),
    "umform.Metal": ("rolling_angle.png", "Springback against the angle between bend line and rolling direction"),
    "umform.VDie": ("press_brake.png", "Section of a press brake: die, punch and sheet"),
    "umform.Punch": ("press_brake.png", "Section of a press brake: die, punch and sheet"),
    "umform.surfaces.Surface": ("tools.png", "All tools as solids"),
}
CITED = re.compile(r"\b[Ee]qs?\.\s*\(\d\.\d+\)(?:\s*(?:,|and|to|-)\s*\(\d\.\d+\))*")
NUMBER = re.compile(r"\((\d\.\d+)\)")
ALIAS = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")
PAGE = re.compile(r"(?<!`)\bdocs/([\w/-]+)\.md\b(?!`)")


def cite(line: str) -> str:
    """A line of a docstring with links to the equations and pages that it cites."""
    line = CITED.sub(lambda match: NUMBER.sub(r":ref:`(\1) <eq-\1>`", match[0]), line)
    return PAGE.sub(r":doc:`/\1`", line)


def process(app: Sphinx, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Put links and the picture into a docstring."""
    lines[:] = [line if ">>>" in line else cite(line) for line in lines]
    if name in PICTURES:
        file, words = PICTURES[name]
        lines += ["", f".. image:: /images/{file}", f"   :alt: {words}", ""]


def skip_protocol(app: Sphinx, what: str, name: str, thing: object, skip: bool, options: object) -> bool | None:
    """Leave what every term has to the page of `Term`: users of a contact or a tool do not call it."""
    function = getattr(thing, "fget", None) or getattr(thing, "__func__", thing)
    owner = getattr(function, "__qualname__", "").rpartition(".")[0]
    kind = getattr(sys.modules.get(getattr(function, "__module__", "")), owner, None)
    return True if name in TERM and isinstance(kind, type) and issubclass(kind, Term) and kind is not Term else None


def short_aliases(
    app: Sphinx, what: str, name: str, thing: object, options: object, signature: str | None, result: str | None
) -> tuple[str | None, str | None]:
    """Names of the aliases of types in a signature as they are in the code."""
    return tuple(text and ALIAS.sub(r"\1", text) for text in (signature, result))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx; after numpydoc, which reads the sections."""
    app.connect("autodoc-process-docstring", process, priority=900)
    app.connect("autodoc-process-signature", short_aliases)
    app.connect("autodoc-skip-member", skip_protocol)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
