"""An order of the bends without collision, by sections; a part that has none; stops of the operator."""

from __future__ import annotations

from dataclasses import replace

import pytest
from brackets import BRACKETS, strip, write

from umform.errors import UmformError
from umform.flat_pattern import AllowanceTable, KFactor, Orders, Tooling, flat
from umform.flat_pattern.operator_sheet import steps_of, write_sheet
from umform.processes.bend_sequence import Bodies
from umform.processes.bend_sequence.foreseen_collisions import foreseen_collisions

UNFOLDED = [name for name, bracket in BRACKETS.items() if not bracket.refused]
#: Offsets and lips shorter than the die needs.
SHORT = {"joggle"}


def orders_of(pattern, **tools):
    return Orders(pattern, Tooling(**tools), Bodies())


@pytest.mark.parametrize("name", UNFOLDED)
def test_an_order_is_found_and_collides_nowhere(pattern, name):
    made = pattern(name)
    if name in SHORT:
        assert made.order == () and "looked for: bend 1: a flange is too short for the die" in made.warnings[-1]
        return
    assert sorted(made.order) == [bend.number for bend in made.bends]
    orders = orders_of(made)
    for number in made.order:
        for section in orders.sections[number]:
            numbers = [n for n in made.order if n in dict(section.places)]
            assert not foreseen_collisions(orders.sequence(section, numbers))


def test_a_deep_narrow_channel_has_no_order(tmp_path):
    made = flat(write(strip([70, 24, 70], [90, 90], base=1).shape(), tmp_path / "deep.step"), allowance=KFactor(0.44))
    assert made.order == ()
    words = " ".join(made.warnings)
    assert "no order of bends 1, 2 without collision was found" in words
    assert "bend 1 after 2" in words and "bend 2 after 1" in words and "punch" in words


def test_the_order_is_searched_where_not_every_order_works(pattern):
    """Lips first: after the flanges, the punch does not fit between them."""
    made = pattern("lipped")
    orders = orders_of(made)
    (section,) = orders.sections[1]
    lips, flanges = ({section.places[k][0] for k in places} for places in ((0, 3), (1, 2)))
    assert set(made.order[:2]) == lips
    assert "punch" in orders.hits(min(lips), frozenset(flanges))


@pytest.mark.parametrize(
    ("name", "prismatic"), [("u", True), ("five", True), ("rounded corners", True), ("box", False), ("tabs", False)]
)
def test_prismatic_parts_are_known(pattern, name, prismatic):
    assert orders_of(pattern(name)).is_prismatic is prismatic


def test_bends_of_cuts_of_their_own_are_searched_by_themselves(pattern):
    made = pattern("box")
    groups = orders_of(made)._groups()
    assert sorted(map(len, groups)) == [2, 2]
    assert all(set(made.order[k : k + 2]) in groups for k in (0, 2))
    assert list(map(len, orders_of(pattern("hat"))._groups())) == [4]


def test_short_flanges_are_warned_of(pattern):
    words = [text for text in pattern("joggle").warnings if "shortest flat flange" in text]
    assert len(words) == 2 and "a die of opening 12 needs" in words[0]


def test_stops_are_flat_edges_first_then_square_flanges(pattern):
    made = pattern("z")
    steps = steps_of(orders_of(made))
    assert [step.against for step in steps] == ["flat edge", "flat edge"]
    arc = 0.5 * made.bends[0].allowance.length
    assert [step.stop for step in steps] == pytest.approx([30.0 + arc, 30.0 + arc], abs=1e-6)
    assert [step.turned for step in steps] == [False, True]
    lipped = steps_of(orders_of(pattern("lipped")))
    assert lipped[2].against.startswith("outer face of the flange of bend")
    # From the bend line to the outer face of the lip: the outer length of the flange less half of a bend deduction.
    deduction = 2.0 * 4.0 - lipped[2].bend.allowance.length
    assert lipped[2].stop == pytest.approx(30.0 + 8.0 - 0.5 * deduction, abs=1e-6)


def test_a_table_gives_the_allowance_and_is_not_extrapolated(tmp_path, step):
    path = tmp_path / "bends.csv"
    path.write_text("# ours\nangle,radius,thickness,allowance\n60,2,2,3.1\n90,2,2,4.4\n120,2,2,5.9\n")
    table = AllowanceTable.read(path)
    made = flat(step("l"), allowance=table)
    assert made.size.max() == pytest.approx(70.0 + 4.4, abs=1e-6)
    assert table(75.0, 2.0, 2.0).length == pytest.approx(3.75)
    assert made.bends[0].allowance.source == "table bends.csv"
    close = AllowanceTable(((90.0, 2.0, 2.0, 4.4), (90.0, 2.01, 2.0, 4.5)), "close")  # rows of nearly one radius
    assert [close(90.0, radius, 2.0).length for radius in (2.0, 2.01)] == [4.4, 4.5]
    for bend in ((130.0, 2.0, 2.0), (90.0, 3.0, 2.0), (90.0, 2.0, 1.0)):
        with pytest.raises(ValueError, match="no allowance for this bend"):
            table(*bend)
    for row, text in (
        ("90,2,2,4.9", "each bend once"),
        ("150,2,2,-1.2", "each bend once"),
        ("150,2,2,nan", "the allowance is not a number"),
        ("150,2,2,", "the allowance is not a number"),
        ("150,2,2", "this row has 3 cells"),
    ):
        path.write_text(f"Angle, radius, thickness, allowance\n60,2,2,3.1\n90,2,2,4.4\n{row}\n")
        with pytest.raises(UmformError, match=text) as error:
            AllowanceTable.read(path)
        assert error.value.where == f"{path}, line 4"
    for text in ("angle,radius,allowance\n60,2,3.1\n", "angle;radius;thickness;allowance\n60;2;2;3,1\n", "# none\n"):
        path.write_text(text)
        with pytest.raises(OSError, match=r"thickness|no rows"):
            AllowanceTable.read(path)
    with pytest.raises(ValueError, match="DIN 6935"):
        KFactor(44)
    with pytest.raises(ValueError, match="returns an Allowance"):
        flat(step("l"), allowance=lambda angle, radius, thickness: 4.4)


def test_a_table_of_bend_table_gives_deductions(tmp_path, step):
    """What `umform bend table` writes: deductions over the angle between the legs, for one set of tools."""
    path = tmp_path / "bends.csv"
    head = "metal,thickness mm,opening mm,punch_radius mm,die_radius mm,angle degrees,bend_deduction mm\n"
    rows = "DC04,2,16,1.5,2,90,3.8\nDC04,2,16,1.5,2,120,1.9\n"
    path.write_text("# of umform\n" + head + rows)
    made = flat(step("l"), allowance=AllowanceTable.read(path))
    assert made.size.max() == pytest.approx(44.0 + 34.0 - 3.8, abs=1e-6)  # outer lengths less the deduction
    with pytest.raises(ValueError, match="from 90 to 120"):
        AllowanceTable.read(path)(100.0, 2.0, 2.0)
    tooling = Tooling(metal="DC04", opening=16.0)
    assert flat(step("l"), allowance=AllowanceTable.read(path), tooling=tooling).size.max() == made.size.max()
    for other in (replace(tooling, opening=20.0), replace(tooling, metal="1.4301")):
        with pytest.raises(ValueError, match="another metal or die") as error:
            flat(step("l"), allowance=AllowanceTable.read(path), tooling=other)
        assert "DC04 with V 16" in error.value.cause
    for other in ("DC04,2,12,1.5,2,90,3.7\n", "DC04,2,16,1.5,3,90,3.9\n"):  # another opening, another die radius
        path.write_text(head + rows + other)
        with pytest.raises(ValueError, match="2 metals and tools have this thickness"):
            AllowanceTable.read(path)(90.0, 2.0, 2.0)
    with pytest.raises(ValueError, match="has thicknesses of 2;"):
        AllowanceTable.read(path)(90.0, 2.0, 1.0)


@pytest.mark.parametrize("name", ["l", "z"])
def test_the_sheet_has_a_column_only_for_what_a_step_has(pattern, tmp_path, name):
    orders = orders_of(pattern(name))
    page = write_sheet(tmp_path / "sheet.html", orders).read_text()
    turned = any(step.turned for step in steps_of(orders))
    assert turned == (name == "z") == ("<th>turn over</th>" in page)
    assert "<th>stop, mm</th>" in page and "<th>angle under load</th>" not in page  # of a simulated part
