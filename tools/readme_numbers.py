"""Write the table of the README from the results of the verification book: the numbers in it are never typed.

`make verification` calls it after the run; a test calls it with --check.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
BOOK = ROOT / "docs" / "verification"
BEGIN, END = "<!-- verification -->\n", "<!-- /verification -->"

#: Page, and the check on it that the README quotes.
QUOTED = (
    ("drawing-aa6016-cup", "20 degrees: mean height, mm"),
    ("drawing-square-cup", "1.8 mm: draw-in of the sides, mm"),
    ("nonlinear-roof-6-35", "Limit load, N, ANS3DEAS, E_33 tied, 16 intervals"),
    ("plastic-tube", "limit pressure, MI9K3DEAS, E_33 tied, 16 layers"),
    ("contact-hertz-line", "ANS3DEAS, 8 elements over the half-width: peak pressure"),
)


def rows(page: str) -> dict[str, list[str]]:
    """Checks of a page: what -> reference, found, deviation."""
    checks = json.loads((BOOK / "results" / f"{page}.json").read_text(encoding="utf-8"))["checks"]
    return {check["what"]: [check["reference"], check["found"], check["deviation"]] for check in checks}


def table() -> str:
    """The table of the README."""
    lines = ["| case | what | reference | umform | deviation |", "|---|---|---|---|---|"]
    for page, what in QUOTED:
        title = (BOOK / f"{page}.md").read_text(encoding="utf-8").splitlines()[0].removeprefix("# ")
        lines.append(f"| [{title}](docs/verification/{page}.md) | {what} | {' | '.join(rows(page)[what])} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Rewrite the README, or with --check say whether it is as it would be written."""
    text = README.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    fresh = before + BEGIN + table() + END + after
    if "--check" in sys.argv:
        return 0 if fresh == text else 1
    README.write_text(fresh, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
