import json
from pathlib import Path

import pytest

from umform.errors import InvalidValue
from umform.problem.contents import json_schema
from umform.problem.settings import Solution

PAGE = Path(__file__).parents[3] / "docs" / "deck-schema.json"


def test_the_schema_in_the_docs_is_that_of_the_models():
    assert PAGE.read_text(encoding="utf-8") == json_schema(), "umform new --schema > docs/deck-schema.json"


def described(schema):
    """All properties of a schema that have no description."""
    for name, part in schema["$defs"].items():
        for key, value in part.get("properties", {}).items():
            if "description" not in value:
                yield f"{name}.{key}"


def test_each_key_is_described_and_no_other_is_allowed():
    schema = json.loads(json_schema())
    assert list(described(schema)) == []
    assert all(part["additionalProperties"] is False for part in schema["$defs"].values() if part["type"] == "object")
    assert schema["properties"]["title"]["description"]


def test_extrapolation_has_an_order_and_may_be_true_or_false():
    orders = {value: Solution(extrapolate=value).build().extrapolate for value in (0, 1, 2)}
    assert orders == {0: 0, 1: 1, 2: 2}
    assert [Solution(extrapolate=value).build().extrapolate for value in (False, True)] == [0, 1]
    for value in (3, -1, 1.5, "line"):
        with pytest.raises(InvalidValue, match="0, 1 or 2"):
            Solution(extrapolate=value)
