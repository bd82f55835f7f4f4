"""Tables of contents from the links of a page, so that Markdown needs none; pages and files from outside docs/."""

from __future__ import annotations

import os
import re
from pathlib import Path

from sphinx.application import Sphinx

#: Pages whose links, in their order, are the chapters below them.
CONTENTS = {"README", "tutorials/README", "notebooks/README", "theory/README", "verification/README"}
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
#: Where the page of the site stands in the page of the root that it shows; where cards of all formed parts are.
DOORS, PARTS = "<!-- doors of the site: docs/index.md -->", "<!-- cards of docs/gallery.md -->"
PART = re.compile(r"^## (.+)\n\n!\[[^\]]*\]\((\S+)\)", flags=re.M)
TREE = ":::{{toctree}}\n:hidden:\n\n{}\n:::\n"


def chapters(file: Path, text: str) -> list[str]:
    """Pages of the folder of a page, or its details: those that it links to in their order, then the others."""
    linked = [target for target, _ in LINK.findall(text) if "/" not in target]
    pages = (*file.parent.glob("*.md"), *file.parent.glob("*.ipynb"))
    present = {path.name for path in pages} - {file.name, "index.md"}
    details = {name for name in present if any(name.startswith(f"{page}-") for page in DETAILED)}
    present = details if file.stem in DETAILED else present - details
    return list(dict.fromkeys([*(name for name in linked if name in present), *sorted(present)]))


def part_cards(gallery: str) -> str:
    """A card for each part of the gallery, with its picture; it leads to the part."""
    cards = []
    for title, picture in PART.findall(gallery):
        anchor = re.sub(r"[^\w-]", "", title.lower().replace(" ", "-"))
        link = f":link: ../gallery.html#{anchor}\n:link-type: url"
        cards.append(f":::{{grid-item-card}} {title}\n:img-top: ../{picture}\n:img-alt: {title}\n{link}\n:::\n")
    return f"::::{{grid}} 1 2 2 3\n:gutter: 3\n\n{''.join(cards)}::::\n"


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
            shown_text = with_links_of((docs.parent / name).read_text(), docs.parent, file, docs)
            before, mark, after = shown_text.partition(DOORS)
            source[0] = f"{before}{source[0]}{after}" if mark else f"{source[0]}\n{shown_text}"
    if PARTS in source[0]:
        app.env.note_dependency(str(docs / "gallery.md"))
        source[0] = source[0].replace(PARTS, part_cards((docs / "gallery.md").read_text()))
    if page in CONTENTS | DETAILED:
        source[0] += "\n" + TREE.format("\n".join(chapters(file, source[0])))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.connect("source-read", read_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
