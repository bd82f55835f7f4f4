"""A number that a process reports: as text, table, record and columns; the same mark beyond its limit everywhere."""

import json
import math
from dataclasses import dataclass, replace
from typing import Annotated

import pytest

from umform.results.quantity import (
    NO_BAND,
    UNKNOWN,
    Bad,
    Band,
    Quantity,
    columns,
    in_rows,
    list_columns,
    quantities_of,
    side_by_side,
    table,
    values,
)

HEIGHT = Quantity("height", "mm", 2, value=12.3456)


@pytest.mark.parametrize(
    ("changes", "text", "error"),
    [
        ({}, "12.35", NO_BAND),
        ({"value": None}, UNKNOWN, NO_BAND),
        ({"value": math.nan}, UNKNOWN, NO_BAND),
        ({"decimals": None}, "12.35", NO_BAND),
        ({"decimals": None, "digits": 5}, "12.346", NO_BAND),
        ({"decimals": None, "value": -0.0}, "0", NO_BAND),
        ({"band": Band(0.123, "mesh")}, "12.35", "± 0.12"),
        ({"decimals": None, "band": Band(0.00123, "mesh")}, "12.3456", "± 0.0012"),
        ({"decimals": None, "band": Band(0.0, "mesh")}, "12.35", ""),
        ({"band": Band(0.00213, "mesh")}, "12.3456", "± 0.0021"),
        ({"band": Band(1e-12, "round-off")}, "12.35", "± 0.00"),
        ({"band": Band(math.nan, "mesh")}, "12.35", NO_BAND),
        ({"band": Band(0.5, "meshes", middle=11.0)}, "11.00", "± 0.50"),
    ],
)
def test_texts_of_a_number_and_its_error(changes, text, error):
    one = replace(HEIGHT, **changes)
    assert (one.text, one.error_text) == (text, error)


@pytest.mark.parametrize(
    ("changes", "missed"),
    [
        ({"limit": 12.3456}, ""),
        ({"limit": 6.1728}, "MISSED 2 times over"),
        ({"limit": 12.34, "slack": 1e-3}, ""),
        ({"limit": 13.0, "at_least": True}, "MISSED"),
        ({"limit": 12.0, "at_least": True}, ""),
        ({"limit": 12.0, "band": Band(0.1, "meshes", middle=11.0)}, ""),
        ({"limit": 1.0, "value": None}, ""),
    ],
)
def test_a_number_beyond_its_limit_is_marked(changes, missed):
    one = replace(HEIGHT, **changes)
    assert one.verdict == missed and one.missed is bool(missed) and one.record()["missed"] is bool(missed)
    assert isinstance(one.text, Bad) is bool(missed) and one.text.endswith(missed)


def test_an_error_of_round_off_adds_no_digits():
    quantity = Quantity("depth", "mm", value=0.04, band=Band(1e-13, "a difference"))
    assert quantity.number(0.04, "+") == "+0.0400000"
    assert quantity.number(123456.7) == "123457"
    assert quantity.number(0.0) == "0.00000000000000"


@pytest.mark.parametrize(
    ("value", "band", "error", "relative"),
    [
        (-4.0, Band(0.5, "mesh"), 0.5, 0.125),
        (0.0, Band(0.5, "mesh"), 0.5, 0.0),
        (None, Band(0.5, "mesh"), 0.5, 0.0),
        (4.0, Band(math.nan, "mesh"), 0.0, 0.0),
        (4.0, None, 0.0, 0.0),
    ],
)
def test_the_error_of_a_shade(value, band, error, relative):
    one = Quantity("height", "mm", value=value, band=band)
    assert (one.error, one.relative_error) == (error, relative)


def test_a_full_text_has_error_and_unit():
    assert HEIGHT.full_text == "12.35 mm"
    assert Quantity("angle", "degrees", 1, value=90.0, band=Band(0.2, "mesh")).full_text == "90.0 ± 0.2°"
    assert Quantity("ratio", value=0.5).full_text == "0.5"


@dataclass(frozen=True)
class Measures:
    """Numbers of a test."""

    height: Annotated[float, Quantity("height", "mm", 2, hint="of the cup")]
    other: float
    """No quantity."""
    strain: Annotated[float, Quantity("outer strain", decimals=3)]


def test_a_field_declares_a_quantity():
    found = quantities_of(Measures(1.0, 2.0, math.nan), {"strain": Band(0.1, "mesh")})
    assert values(found) == {"height": 1.0, "strain": None}
    assert [one.label for one in found] == ["height", "outer strain"] and found[1].band is not None


def test_tables_have_the_columns_that_the_bands_need():
    plain = [replace(HEIGHT, hint="of the cup"), Quantity("strain", value=0.1)]
    assert table(plain) == [
        ["quantity", "value", "unit"],
        ["height (of the cup)", "12.35", "mm"],
        ["strain", "0.1", ""],
    ]
    band = Band(0.5, "refinements", middle=12.0, parts={"mesh/2": -0.25})
    assert table([replace(plain[0], band=band), plain[1]]) == [
        ["quantity", "value", "error", "finest mesh", "mesh/2", "unit"],
        ["height", "12.00", "± 0.50", "12.35", "-0.25", "mm"],
        ["strain", "0.1", NO_BAND, "", "", ""],
    ]


def test_several_lists_are_columns_or_rows():
    strain = Quantity("strain", value=0.1)
    assert side_by_side({"1": [HEIGHT], "2": [strain, HEIGHT]}) == [
        ["quantity", "1", "2", "unit"],
        ["height", "12.35", "12.35", "mm"],
        ["strain", "", "0.1", ""],
    ]
    assert in_rows([[HEIGHT, strain]]) == [["height, mm", "strain"], ["12.35", "0.1"]]
    rows = [[HEIGHT], [strain]]
    assert columns(rows) == {"height": [12.3456, None], "strain": [None, 0.1]}
    assert list(columns(rows, units=True)) == ["height mm", "strain"]


def test_a_record_gives_the_quantity_back():
    for band in (None, Band(math.nan, "failed", parts={"mesh/2": math.nan}), Band(0.1, "meshes", 12.0)):
        one = replace(HEIGHT, limit=3.0, band=band)
        kept = json.loads(json.dumps(one.record(), allow_nan=False))
        assert repr(Quantity.of(kept)) == repr(one)  # NaN differs from itself
    extrapolated = replace(HEIGHT, band=Band(0.1, "meshes", middle=HEIGHT.value + 0.3))
    columns = list_columns([HEIGHT, extrapolated])  # those of the printed table
    assert columns["value"] == [HEIGHT.value, HEIGHT.value + 0.3] and columns["finest_mesh"] == [None, HEIGHT.value]
    (row,) = zip(*list_columns([replace(HEIGHT, limit=3.0, band=Band(0.1, "meshes"))]).values(), strict=True)
    assert row == ("height", "height", 12.3456, "mm", 0.1, "meshes", False, 3.0, True)


def test_a_number_of_one_mesh_says_so_in_text_table_and_record():
    one = replace(HEIGHT, of_mesh=True)
    assert one.full_text.endswith("mm, of this mesh")
    assert one.error_text == "of this mesh"
    header, row = table([one])
    assert row[header.index("error")] == "of this mesh"
    assert one.record()["of_mesh"]
    rippling = replace(one, band=Band(0.25, "ripple"))
    assert rippling.error_text.startswith("± 0.2")
    assert rippling.error_text.endswith(", of this mesh")
    old = {name: value for name, value in HEIGHT.record().items() if name != "of_mesh"}
    assert not Quantity.of(old).of_mesh  # a record of an earlier version
