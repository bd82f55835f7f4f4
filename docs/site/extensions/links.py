"""Tables of contents from the links of a page, so that Markdown needs none; pages and files from outside docs/."""

from __future__ import annotations

import os
import re
from pathlib import Path

from sphinx.application import Sphinx

#: Pages whose links, in their order, are the chapters below them.
CONTENTS = {"README", "tutorials/README", "theory/README", "verification/README"}
#: Pages with pages of details, which are named NAME-*.md and are chapters below it.
DETAILED = {"performance"}
#: Pages of the root of the repository, and the pages of the site that show them.
SHOWN = {
    "README.md": "index",
    "CHANGELOG.md": "site/changelog",
    "CONTRIBUTING.md": "site/contributing",
    "CODE_OF_CONDUCT.md": "site/conduct",
    "SECURITY.md": "site/security",
}
LINK = re.compile(r"\]\((?!\w+:|#)([^)#\s]+)((?:#[^)]*)?)\)")
TREE = ":::{{toctree}}\n:hidden:\n\n{}\n:::\n"


def chapters(file: Path, text: str) -> list[str]:
    """Pages of the folder of a page, or its details: those that it links to in their order, then the others."""
    linked = [target for target, _ in LINK.findall(text) if "/" not in target]
    present = {path.name for path in file.parent.glob("*.md")} - {file.name, "index.md"}
    details = {name for name in present if any(name.startswith(f"{page}-") for page in DETAILED)}
    present = details if file.stem in DETAILED else present - details
    return list(dict.fromkeys([*(name for name in linked if name in present), *sorted(present)]))


def with_links_of(text: str, folder: Path, page: Path, docs: Path) -> str:
    """Links of a text that stands in a folder as a page of the site needs them; files outside docs/ are downloads."""

    def link(match: re.Match[str]) -> str:
        target = (folder / match[1]).resolve()
        if not target.is_file():
            return match[0]
        if target.parent == docs.parent and target.name in SHOWN:
            target = docs / f"{SHOWN[target.name]}.md"
        scheme = "" if target.is_relative_to(docs) else "path:"
        return f"]({scheme}{os.path.relpath(target, page.parent)}{match[2]})"

    return LINK.sub(link, text)


def read_page(app: Sphinx, page: str, source: list[str]) -> None:
    """Text of a page of the root, links that lead somewhere, chapters as a hidden table of contents."""
    docs = Path(app.srcdir).resolve()
    file = Path(app.env.doc2path(page)).resolve()
    if file.suffix != ".md":
        return
    source[0] = with_links_of(source[0], file.parent, file, docs)
    for name, shown in SHOWN.items():
        if shown == page:
            app.env.note_dependency(str(docs.parent / name))
            source[0] += "\n" + with_links_of((docs.parent / name).read_text(), docs.parent, file, docs)
    if page in CONTENTS | DETAILED:
        source[0] += "\n" + TREE.format("\n".join(chapters(file, source[0])))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.connect("source-read", read_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
