"""Write the summary of docs/performance.md from the tables of its detail pages: the numbers in it are never typed.

Run it after a benchmark has rewritten a table; a test calls it with --check.
"""

from __future__ import annotations

import sys
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
PAGE = DOCS / "performance.md"
BEGIN, END = "<!-- summary -->\n", "<!-- /summary -->"

#: What is measured, page, cells that identify the row, result with the row's cells, command.
QUOTED = (
    (
        "Strip bent over a cylinder, CPU time",
        "performance-codes",
        ("a", "umform BEND8, 40 x 1 x 1, tolerance 5e-3"),
        "{4} times less than {3}; {1}",
        "make peers",
    ),
    (
        "The same with free edges, CPU time",
        "performance-codes",
        ("w", "umform BEND8, 48 x 3 x 1, tolerance 1e-4", "CalculiX C3D8I, 48 x 4 x 2"),
        "{4} times less than {3}; {1}",
        "make peers",
    ),
    (
        "Pinched hemisphere, CPU time",
        "performance-codes",
        ("b", "same mesh", "umform EAS3DEAS, 48 x 48, tolerance 1e-4"),
        "{4} times less than {3}; {1}",
        "make peers",
    ),
    (
        "Linear step, 100 000 hexahedra, CPU time",
        "performance-codes",
        ("c", "CalculiX C3D8I, 500 x 200"),
        "{4} times less than {3}, {7} times less memory",
        "make peers",
    ),
    (
        "U-bend with friction, 70 mm",
        "performance-codes",
        ("umform, BEND8, 3 x 3 points",),
        "{3} CPU s, {5} iterations",
        "make ubend",
    ),
    (
        "Adaptive increments, free bending",
        "performance-increments",
        ("free bending, 24x1 ANS3DEAS",),
        "{5} iterations instead of {2}; force within {7}",
        "python benchmarks/pace.py",
    ),
    (
        "Sphere into a sheet, 160 000 elements",
        "performance-increments",
        ("160000",),
        "{3} CPU s per iteration, {4} GB",
        "make dome",
    ),
    (
        "Factorisation, 241 200 equations, L D L^T",
        "performance-solving",
        ("200x200", "indefinite"),
        "{5} ms; PARDISO {6} ms",
        "python benchmarks/sparse.py",
    ),
    (
        "ANS3DEAS with plastic J2, residual and tangent",
        "performance-kernels",
        ("ANS3DEAS", "J2 plastic", "20"),
        "{3} us per element, {6} of the peak",
        "python benchmarks/kernels.py",
    ),
    (
        "300 random jobs",
        "robust-rate",
        ("all", "300"),
        "{2} finish; {6} of the evaluations are discarded",
        "make robust",
    ),
    (
        "200 random jobs of drawing and forming",
        "robust-draws",
        ("all", "200"),
        "{2} finish; {6} of the evaluations are discarded",
        "make robust-draws",
    ),
)


def row(page: str, wanted: tuple[str, ...]) -> list[str]:
    """Cells of the only table row of a page that has all wanted cells.

    Raises
    ------
    SystemExit
        If no row or several rows have them.
    """
    lines = (DOCS / f"{page}.md").read_text(encoding="utf-8").splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    found = [cells for cells in rows if set(wanted) <= set(cells)]
    if len(found) != 1:
        raise SystemExit(f"{page}.md: {len(found)} rows with {wanted}: correct QUOTED in {Path(__file__).name}")
    return found[0]


def table() -> str:
    """The summary."""
    lines = ["| what | result | command |", "|---|---|---|"]
    for what, page, wanted, result, command in QUOTED:
        lines.append(f"| [{what}]({page}.md) | {result.format(*row(page, wanted))} | `{command}` |")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Rewrite the summary, or with --check say whether it is as it would be written."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    fresh = before + BEGIN + table() + END + rest.split(END)[1]
    if "--check" in sys.argv:
        return 0 if fresh == text else 1
    PAGE.write_text(fresh, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
