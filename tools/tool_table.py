"""Write the table of tools in docs/tools.md from the classes of umform.surfaces; with --check only compare."""

import sys
from dataclasses import MISSING
from pathlib import Path

from umform.spec import parameters
from umform.spec.known import known
from umform.surfaces import ToolSpec

PAGE = Path(__file__).parents[1] / "docs" / "tools.md"
HEAD, END = "| tool | what it is |\n|---|---|\n", "| `UserSurface(function)`"


def rows() -> str:
    """A row for each tool: its fields, those with a default in brackets, and the first sentence of its docstring."""
    table = ""
    for name, kind in known("umform.surfaces", ToolSpec).items():
        names = [one.name if one.default is MISSING else f"[{one.name}]" for one in parameters(kind).values()]
        what = (kind.__doc__ or "").partition("\n")[0].partition(" eq")[0].rstrip(".").replace("``", "`")
        table += f"| `{name}({', '.join(sorted(names, key=lambda one: one[0] == '['))})` | {what} |\n"
    return table


def main() -> int:
    """Write or compare the table."""
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.partition(HEAD)[0], text[text.index(END) :]
    now = before + HEAD + rows() + after
    if "--check" in sys.argv:
        return int(now != text)
    PAGE.write_text(now, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
