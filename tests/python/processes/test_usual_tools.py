"""Usual tools of press brakes: names, sizes, tools that no list has."""

import pytest

from umform.errors import InvalidValue
from umform.processes.air_bending import AirBending
from umform.processes.air_bending.usual_tools import usual_tool, usual_tools


def test_names_are_those_of_the_sizes():
    names = {(one.kind, one.name) for kind in ("die", "punch") for one in usual_tools(kind)}
    assert len(names) == len(usual_tools("die")) + len(usual_tools("punch")) > 150
    die, punch = usual_tool("die", "V16/88"), usual_tool("punch", "88/R0.8")
    assert die.sizes == {"opening": 16.0, "die_angle": 88.0, "die_radius": 2.0}
    assert punch.sizes == {"punch_angle": 88.0, "punch_radius": 0.8}
    case = AirBending(**die.sizes, **punch.sizes)
    assert (case.opening, case.die_angle, case.punch_radius) == (16.0, 88.0, 0.8)


def test_the_list_reaches_from_v_6_to_v_100_and_from_30_to_90_degrees():
    dies = usual_tools("die")
    assert {6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0, 40.0, 50.0, 63.0, 80.0, 100.0} <= {
        one.sizes["opening"] for one in dies
    }
    for sizes, name in ((dies, "die_angle"), (usual_tools("punch"), "punch_angle")):
        assert {30.0, 60.0, 80.0, 85.0, 88.0, 90.0} <= {one.sizes[name] for one in sizes}


@pytest.mark.parametrize("name", ["v16/88", " V 16 / 88° ", "V16/88"])
def test_capitals_and_blanks_do_not_matter(name):
    assert usual_tool("die", name).name == "V16/88"


def test_a_tool_of_another_name_is_refused_with_near_ones():
    with pytest.raises(InvalidValue, match="no usual die has this name") as refused:
        usual_tool("die", "V16/87")
    assert "V16/88" in refused.value.cause and "umform tools" in refused.value.remedy
