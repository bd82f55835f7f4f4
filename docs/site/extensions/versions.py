"""The menu of versions: one folder a version, side by side, and `switcher.json` that names them."""

from __future__ import annotations

import json
from pathlib import Path

from sphinx.application import Sphinx


def by_number(name: str) -> tuple[int, ...]:
    """Key that sorts versions such as 0.10.1."""
    return tuple(int(part) for part in name.split(".") if part.isdigit())


def write_switcher(app: Sphinx, error: Exception | None) -> None:
    """Name the versions that lie beside this one, newest first, and lead from the root to the newest."""
    if error or app.builder.format != "html":
        return
    root = Path(app.outdir).parent
    names = sorted((page.parent.name for page in root.glob("*/index.html")), key=by_number, reverse=True)
    base = app.config.versions_url.rstrip("/")
    entries = [{"version": name, "url": f"{base}/{name}/", "preferred": name == names[0]} for name in names]
    (root / "switcher.json").write_text(json.dumps(entries, indent=1) + "\n")
    target = f"{names[0]}/index.html"
    (root / "index.html").write_text(
        f'<!doctype html><meta charset="utf-8"><meta http-equiv="refresh" content="0; url={target}">'
        f'<title>umform</title><a href="{target}">umform {names[0]}</a>\n'
    )


def setup(app: Sphinx) -> dict[str, bool]:
    """Register with Sphinx."""
    app.add_config_value("versions_url", "/", "html")
    app.connect("build-finished", write_switcher)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
