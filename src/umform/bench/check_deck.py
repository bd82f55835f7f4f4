"""The process of a check: ``python -m umform.bench.check_deck DECK FOLDER`` prints its findings as JSON."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path

from umform.bench.limits import limit_memory
from umform.errors import UmformError
from umform.problem.check import check
from umform.problem.errors import DeckError
from umform.problem.problem import Problem


def findings(path: Path, folder: Path) -> list[dict[str, str]]:
    """Findings of a deck; an error that prevents reading or building is one of them."""
    try:
        deck = Problem.read(path.read_text(encoding="utf-8"), "deck.toml", folder)
        return [{**asdict(found), "level": found.level.value} for found in check(deck, deck.build())]
    except DeckError as error:
        return [_row(one) for one in error.errors[:50]]
    except UmformError as error:
        return [_row(error)]
    except MemoryError:
        return [
            {"level": "error", "about": "mesh", "text": "not enough memory for this model", "remedy": "fewer elements"}
        ]


def _row(error: UmformError) -> dict[str, str]:
    text = "; ".join(part for part in (error.what, str(error.value or "")[:200], error.cause) if part)
    return {"level": "error", "about": error.where, "text": text, "remedy": error.remedy}


if __name__ == "__main__":
    limit_memory()
    print(json.dumps(findings(Path(sys.argv[1]), Path(sys.argv[2]))))
