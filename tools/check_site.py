"""Look at the site of `make docs`: outputs of notebooks; in a browser, lengths of pages, widths on a phone, search.

Call: python tools/check_site.py build/docs/0.2.0
"""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

#: Longest page of the API in pixels at a width of 1440, and how many of the largest files are looked at: those beyond
#: are half as long, and a browser takes half a second for each of 400.
LONGEST, LARGEST = 8000, 40
#: Words, and a page that must be among those found first.
FOUND = {"springback": "bend", "find_stroke": "find_stroke", "V-die": "die"}
#: Pages that are looked at on a phone, in both schemes.
ON_A_PHONE = ("index.html", "site/gallery.html", "site/api/model.html", "notebooks/bend.html", "README.html")
#: Where the notebooks are, and what else is there.
NOTEBOOKS, BESIDE = Path(__file__).parents[1] / "docs" / "notebooks", {"README.md"}
#: Pictures that each notebook shows at least.
PICTURES = {"bend": 3, "cup": 3, "own-law": 1}


def main(root: Path) -> int:
    """Print what is wrong; return their number."""
    wrong = [*notebooks(root), *in_a_browser(root)]
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return len(wrong)


def notebooks(root: Path, source: Path = NOTEBOOKS) -> Iterator[str]:
    """Notebooks without their pictures and tables, or with warnings; files that they leave where they are."""
    left = {path.name for path in source.iterdir()} - {f"{name}.ipynb" for name in PICTURES} - BESIDE
    if left:
        yield f"the notebooks leave files in {source}: {', '.join(sorted(left))}"
    for name, pictures in PICTURES.items():
        text = (root / "notebooks" / f"{name}.html").read_text()
        shown = len(re.findall(r'<img[^>]*src="[^"]*_images/', text))
        if shown < pictures:
            yield f"the notebook {name} shows {shown} pictures; at least {pictures}"
        if 'class="output text_html"' not in text:
            yield f"the notebook {name} shows no result as a table"
        if 'class="output stderr' in text:
            yield f"the notebook {name} prints warnings"


def in_a_browser(root: Path) -> list[str]:
    """What is wrong with the pages as a browser shows them."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        print("no look at the site: playwright is not installed (make dev)")
        return []
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        print("no look at the site: there is no chromium")
        return []
    with sync_playwright() as tools:
        window = tools.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        wrong = [*long_pages(window, root), *wide_pages(window, root), *not_found(window, root)]
        window.close()
    return wrong


def long_pages(window: Any, root: Path) -> Iterator[str]:
    """Pages of the API that nobody reads to their end."""
    page = window.new_page(viewport={"width": 1440, "height": 900})
    files = (root / "site" / "api").rglob("*.html")
    for file in sorted(files, key=lambda file: file.stat().st_size)[-LARGEST:]:
        page.goto(file.as_uri(), wait_until="domcontentloaded")
        height = page.evaluate("document.documentElement.scrollHeight")
        if height > LONGEST:
            yield f"{file.relative_to(root)} is {height} pixels long; at most {LONGEST}"


def wide_pages(window: Any, root: Path) -> Iterator[str]:
    """Pages that scroll sideways on a phone, and errors of their scripts."""
    for scheme in ("light", "dark"):
        page = window.new_page(viewport={"width": 390, "height": 844}, color_scheme=scheme)
        errors: list[str] = []
        page.on("pageerror", lambda error, errors=errors: errors.append(str(error)))
        for name in ON_A_PHONE:
            page.goto((root / name).as_uri())
            page.wait_for_timeout(300)
            width = page.evaluate("document.documentElement.scrollWidth")
            if width > 390:
                yield f"{name} is {width} pixels wide on a phone of 390"
            shown = page.evaluate("document.documentElement.dataset.theme")
            if shown != scheme:
                yield f"{name} is {shown} where {scheme} is wanted"
        yield from errors


def not_found(window: Any, root: Path) -> Iterator[str]:
    """Words that the search of the site does not find."""
    page = window.new_page()
    for words, target in FOUND.items():
        page.goto(f"{(root / 'search.html').as_uri()}?q={words}")
        try:
            page.wait_for_selector("#search-results li a", timeout=10_000)
        except Exception as error:
            yield f"the search for {words} found nothing: {str(error).splitlines()[0]}"
            continue
        page.wait_for_timeout(500)
        links = page.eval_on_selector_all("#search-results li a", "all => all.map(one => one.getAttribute('href'))")
        if not any(target in link for link in links[:10]):
            yield f"the search for {words} found {links[:10]}, not {target}"


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
