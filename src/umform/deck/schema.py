"""The JSON schema of decks, for editors: completion, descriptions and errors while typing."""

from __future__ import annotations

import json

from umform.deck.contents import Contents


def json_schema() -> str:
    """JSON schema (draft 2020-12) of all that may stand in a deck."""
    schema = Contents.model_json_schema()
    head = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Deck of umform",
        "description": schema.pop("description"),
    }
    schema.pop("title")
    return json.dumps(head | schema, indent=1) + "\n"
