"""Tables of a deck from dataclasses: values are objects, errors of the object have their place, the schema has all."""

from dataclasses import dataclass
from typing import Annotated, Literal

import pytest
from annotated_types import Gt
from pydantic import TypeAdapter, ValidationError

from umform.errors import InvalidValue
from umform.problem.tagged import describe, table, tagged
from umform.spec import About, OneOf, check_fields

Size = Annotated[float, Gt(0.0), About("mm")]


@dataclass(frozen=True)
class Ring:
    """A ring."""

    inner: Size
    """Inner radius."""
    outer: Size = 5.0
    """Outer radius."""

    def __post_init__(self):
        check_fields(self)
        if self.inner >= self.outer:
            raise InvalidValue("a ring has a hole", where="inner", value=self.inner, cause="exchanged", remedy="less")


@dataclass(frozen=True)
class Ball:
    """A ball."""

    radius: Size
    """Radius."""
    centre: tuple[float, float] = (0.0, 0.0)
    """Centre."""
    points: int | Literal["auto"] = 3
    """Points."""
    skin: Ring | None = None
    """Skin."""


@dataclass(frozen=True)
class Placed:
    """A thing in its place."""

    thing: Ball | Ring
    height: float = 0.0
    """Height."""


@dataclass(frozen=True)
class Pair:
    """Two things."""

    first: Annotated[object, OneOf("kind", lambda: KINDS)]
    """First."""
    second: Annotated[object, OneOf("kind", lambda: KINDS)] | None = None
    """Second."""


KINDS = {"Ball": Ball, "Ring": Ring}


def read(kind, value):
    return TypeAdapter(kind).validate_python(value)


def test_a_table_is_an_object_of_the_class():
    things = tagged("kind", KINDS)
    assert read(things, {"kind": "Ring", "inner": 1}) == Ring(1.0)
    found = read(things, {"kind": "Ball", "radius": 2.0, "centre": [1, 2], "points": "auto", "skin": {"inner": 4.5}})
    assert found == Ball(2.0, (1.0, 2.0), "auto", Ring(4.5))


def test_objects_of_python_stay_as_they_are():
    ball, own = Ball(1.0, skin=Ring(1.0)), object()
    assert read(tagged("kind", KINDS), ball) is ball
    assert read(tagged("kind", KINDS), own) is own
    assert read(table(Pair), {"first": ball}).first is ball
    assert read(tagged("kind", KINDS, Placed), ball) == Placed(ball)


def test_further_keys_are_those_of_the_class_around():
    within = tagged("kind", KINDS, Placed)
    assert read(within, {"kind": "Ring", "inner": 1.0, "height": 2.0}) == Placed(Ring(1.0), 2.0)
    assert read(within, Placed(Ring(1.0), 3.0)).height == 3.0


def test_choices_within_fields():
    found = read(table(Pair), {"first": {"kind": "Ball", "radius": 1.0}, "second": {"kind": "Ring", "inner": 2.0}})
    assert found == Pair(Ball(1.0), Ring(2.0))


@pytest.mark.parametrize(
    ("value", "place", "kind"),
    [
        ({"kind": "Ring", "inner": 6.0}, ("Ring",), "object"),
        ({"kind": "Ring", "inner": -6.0}, ("Ring", "inner"), "greater_than"),
        ({"kind": "Ring", "inner": "6"}, ("Ring", "inner"), "float_type"),
        ({"kind": "Ring", "inner": 1.0, "colour": 1}, ("Ring", "colour"), "extra_forbidden"),
        ({"kind": "Ball"}, ("Ball", "radius"), "missing"),
        ({"kind": "Ball", "radius": 1.0, "points": "some"}, ("Ball", "points", "word"), "literal_error"),
        ({"kind": "Ball", "radius": 1.0, "centre": ["1", 2]}, ("Ball", "centre", 0), "float_type"),
        ({"kind": "Cube"}, (), "union_tag_invalid"),
    ],
)
def test_errors_have_their_place(value, place, kind):
    with pytest.raises(ValidationError) as refusal:
        read(tagged("kind", KINDS), value)
    (error,) = refusal.value.errors()
    assert (error["loc"], error["type"]) == (place, kind)
    if kind == "object":
        assert error["ctx"]["error"].remedy == "less"


def test_the_schema_has_words_units_and_texts():
    things = tagged("kind", KINDS)
    describe()
    schema = TypeAdapter(things).json_schema()
    ring = next(part for part in schema["$defs"].values() if "kind" in part["properties"] and part["title"] == "Ring")
    assert ring["properties"]["kind"]["const"] == "Ring"
    assert ring["properties"]["inner"] == {
        "description": "Inner radius.",
        "exclusiveMinimum": 0.0,
        "title": "Inner",
        "type": "number",
        "unit": "mm",
    }
    assert ring["properties"]["outer"]["default"] == 5.0
    assert ring["required"] == ["kind", "inner"] and ring["description"] == "A ring."
    assert schema["discriminator"]["propertyName"] == "kind"
