"""Values of other types: each is refused in the words of its field, in all processes and studies."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.flat_pattern import AllowanceTable, ComputedBends, KFactor, Tooling, bend_part, flat
from umform.processes.air_bending import AirBending, StackedSheet, air_bending, angle_table, bending_table, find_stroke
from umform.processes.air_bending.bottoming import press_to_force
from umform.processes.bend_sequence import Bend, BendSequence, Bodies, bend_sequence
from umform.processes.bending.case import free_bending
from umform.processes.bending.spec import FreeBending
from umform.processes.draw import Cup, UBend, draw
from umform.processes.draw.cup import ESAFORM
from umform.processes.draw.u_bend import NUMISHEET
from umform.processes.draw_bead import DrawBead, drawn_through
from umform.processes.hemming import Hemming, hemming
from umform.studies.bend_table import BendTable, bend, bend_key, bend_table, bends, correct, setups, write_table

STEEL = uf.sheet_metals.get("DC04").law
CASES: list[Any] = [
    AirBending(),
    StackedSheet(1.0, STEEL),
    Bend(20.0, 90.0),
    Bodies(),
    BendSequence(60.0, [Bend(20.0, 90.0)]),
    Hemming(),
    Cup(material=STEEL, **ESAFORM),
    UBend(material=STEEL, **NUMISHEET),
    DrawBead(material=STEEL),
    FreeBending(),
    KFactor(0.4),
    Tooling(),
    ComputedBends(),
]
WRONG = [5, "a", np.ones(2), np.array(1.0), np.array(["a", "b"]), [1], (1, "a"), {"a": 1}, object(), None, float("nan")]


@pytest.mark.parametrize("case", CASES, ids=lambda case: type(case).__name__)
def test_any_value_of_any_field_is_taken_or_refused_with_place_cause_and_remedy(case):
    for field in fields(case):
        for value in WRONG:
            try:
                replace(case, **{field.name: value})
            except InvalidValue as error:
                assert error.where and error.cause and error.remedy, f"{field.name} = {value!r}: {error}"


@pytest.mark.parametrize(
    ("kind", "name", "value", "what"),
    [
        (
            AirBending(),
            "on_top",
            5,
            "the further sheets must be an array whose entries are each an object Stacked",
        ),
        (AirBending(), "on_top", [5], "the further sheets must be an array"),
        (AirBending(), "element", 5, "element must be a text or an object Element"),
        (
            AirBending(),
            "contact_points",
            np.ones(2),
            "the contact points per direction and facet must be a whole",
        ),
        (Cup(material=STEEL, **ESAFORM), "newton", 5, "newton must be an object NewtonOptions"),
        (UBend(material=STEEL, **NUMISHEET), "pace", "a", "pace must be an object Pace"),
        (BendSequence(60.0, [Bend(20.0, 90.0)]), "bends", "up", "the bends must be an array"),
        (Bend(20.0, 90.0), "tools", 5, "tools must be a dictionary"),
        (Hemming(), "form", np.array(["flat", "open"]), "the form of the hem must be flat"),
    ],
)
def test_a_value_of_another_type_is_refused_by_the_declaration_of_its_field(kind, name, value, what):
    with pytest.raises(InvalidValue) as refusal:
        replace(kind, **{name: value})
    assert refusal.value.what.startswith(what) and refusal.value.where == name


def test_a_k_factor_of_another_type_has_the_name_of_its_option():
    with pytest.raises(InvalidValue, match="the K-factor must be a number from 0 to 1") as refusal:
        KFactor("a")
    assert refusal.value.where == "k_factor"


@pytest.mark.parametrize("case", CASES[:10], ids=lambda case: type(case).__name__)
def test_a_process_names_its_parameters_beside_one_that_it_does_not_have(case):
    with pytest.raises(InvalidValue, match=f"{type(case).__name__} has no parameter limit") as refusal:
        replace(case, limit=0.3)
    assert next(field.name for field in fields(case)) in refusal.value.remedy


def test_what_is_imported_for_types_only_is_known_by_the_name_of_its_class():
    class Own(uf.NewtonOptions):
        """Options of one's own."""

    element, options = uf.elements.element("BEND8"), Own()
    assert AirBending(element=element).element is element
    assert Cup(material=STEEL, newton=options, **ESAFORM).newton is options


def test_one_sheet_and_one_bend_need_no_list():
    sheet, one = StackedSheet(1.0, STEEL), Bend(20.0, 90.0)
    assert AirBending(thickness=1.0, on_top=sheet).on_top == (sheet,)
    assert AirBending(thickness=1.0, on_top=(one for one in [sheet])).on_top == (sheet,)
    assert BendSequence(60.0, one).bends == (one,)


CASE = AirBending(opening=8.0, thickness=1.0)
WANTED = setups("DC04", CASE)
CALLS = {
    "air_bending": lambda: air_bending(5),
    "find_stroke": lambda: find_stroke(5, 120.0),
    "bending_table": lambda: bending_table(CASE, 3.0),
    "angle_table": lambda: angle_table(CASE, ["a"]),
    "press_to_force": lambda: press_to_force(5, 100.0),
    "bend_sequence": lambda: bend_sequence(CASE),
    "hemming": lambda: hemming(CASE),
    "draw": lambda: draw(Cup(material=STEEL, **ESAFORM), limit=0.3),
    "drawn_through": lambda: drawn_through(5),
    "free_bending": lambda: free_bending(5),
    "bend_table, angles": lambda: bend_table(WANTED, 120),
    "bend_table, wanted": lambda: bend_table([5], [120.0]),
    "bend_table, store": lambda: bend_table(WANTED, [120.0], store="here"),
    "bend_table, notes": lambda: bend_table(WANTED, [120.0], notes=5),
    "setups, metals": lambda: setups(5, CASE),
    "setups, thicknesses": lambda: setups(["DC04"], CASE, thicknesses=1.0),
    "bend, angle": lambda: bend(CASE, "a"),
    "bends, angles": lambda: bends(CASE, 120.0),
    "bend_key, case": lambda: bend_key(5, 120.0),
    "correct, case": lambda: correct(5, 90.0),
    "write_table, table": lambda: write_table(5, "tables"),
    "write_table, formats": lambda: write_table(BendTable((), 0.1), "tables", 5),
    "flat, path": lambda: flat(5, metal="DC04"),
    "flat, allowance": lambda: flat("part.step", allowance=5),
    "flat, store": lambda: flat("part.step", metal="DC04", store="here"),
    "AllowanceTable, path": lambda: AllowanceTable.read(5),
    "bend_part, orders": lambda: bend_part(5),
}


@pytest.mark.parametrize("where", CALLS)
def test_a_function_refuses_a_value_of_another_type_before_it_runs(where):
    with pytest.raises(InvalidValue) as refusal:
        CALLS[where]()
    assert refusal.value.where.startswith(where) and refusal.value.cause and refusal.value.remedy


def test_a_table_is_written_into_a_folder_given_as_text(tmp_path):
    files = write_table(BendTable((), 0.1), str(tmp_path / "tables"), "csv")
    assert files == [tmp_path / "tables" / "bends.csv"] and files[0].exists()
