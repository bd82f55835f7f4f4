"""Write the tables of docs/materials.md that list classes of umform.materials: python tools/material_tables.py."""

from __future__ import annotations

import re
from dataclasses import MISSING
from pathlib import Path

from umform.materials import Hardening, RateFactor, YieldFunction
from umform.materials.known import known
from umform.problem.keys import summary
from umform.spec import parameters

PAGE = Path(__file__).parents[1] / "docs" / "materials.md"
KINDS = {"hardening curve": Hardening, "yield function": YieldFunction, "rate factor": RateFactor}


def table(kind: str) -> str:
    """Rows of one table: each class with its fields, and what it is."""
    rows = [f"| {kind} | what it is |", "|---|---|"]
    for name, one in known(KINDS[kind]).items():
        fields = ", ".join(
            field.name if field.default in (MISSING, None) else f"{field.name}={field.default:g}"
            for field in sorted(parameters(one).values(), key=lambda field: field.default not in (MISSING, None))
        )
        rows.append(f"| `{name}({fields})` | {summary(one).replace('|', chr(92) + '|')} |")
    return "\n".join(rows)


def written(text: str) -> str:
    """A page with its tables."""
    for kind in KINDS:
        mark = kind.replace(" ", "-")
        text = re.sub(
            rf"(<!-- {mark} -->\n).*?(<!-- /{mark} -->)",
            lambda found, kind=kind: f"{found[1]}\n{table(kind)}\n\n{found[2]}",
            text,
            flags=re.S,
        )
    return text


if __name__ == "__main__":
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
