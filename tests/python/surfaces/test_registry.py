"""A new tool is one class in one file: it is there in Python, in decks, in their schema and in the docs."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[3] / "tools"
FILE = '''"""Half-space under a tilted plane."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Lt

from umform import _core
from umform.spec import About
from umform.surfaces.directions import Point, point
from umform.surfaces.tool import ToolSpec


@dataclass(frozen=True)
class Ramp(ToolSpec):
    """Half-space under a plane that rises along x."""

    slope: Annotated[float, Ge(0.0), Lt(90.0), About("degrees", cause="a ratio", remedy="an angle")]
    """Slope of the ramp."""
    foot: Point = (0.0, 0.0, 0.0)
    """A point of the plane."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        a = math.radians(self.slope)
        return _core.plane(point(self.foot), (-math.sin(a), 0.0, math.cos(a)))
'''
DECK = """
[mesh]
generator = "strip"
length = 10.0
width = 2.0
thickness = 1.0
cells = [4, 1]
[material]
law = "SVK"
E = 210e3
nu = 0.3
[tools.ramp]
shape = "Ramp"
slope = 10.0
foot = [0.0, 0.0, -1.0]
[contacts.ramp]
tool = "ramp"
faces = "lower"
[[supports]]
kind = "fix"
nodes = "x0"
[controls.pull]
kind = "displacement"
nodes = "x1"
direction = "x"
[[steps]]
kind = "move"
to = { pull = 0.1 }
increments = 2
"""
PROGRAM = """
import json, sys
import umform as uf
from umform.problem import DeckError, Problem
from umform.problem.contents import json_schema

deck = sys.stdin.read()
problem = Problem.read(deck).build()
try:
    Problem.read(deck.replace("slope = 10.0", "slope = 100.0"))
    told = ""
except DeckError as error:
    told = str(error)
sys.path.insert(0, sys.argv[1])
import tool_table

kind = json.loads(json_schema())["$defs"]["Ramp"]["properties"]["slope"]
gap = float(problem.tools["ramp"].gap([(0.0, 0.0, 0.0)])[0][0])
print(json.dumps([repr(uf.Ramp(5.0)), gap, kind, told, tool_table.rows()]))
"""


def test_a_new_tool_is_one_class_in_one_file(package_copy):
    package_copy.write("surfaces/ramp.py", FILE)
    python, gap, schema, told, table = json.loads(package_copy.run(PROGRAM, TOOLS, given=DECK))
    assert python == "Ramp(slope=5.0, foot=(0.0, 0.0, 0.0))"
    assert gap == pytest.approx(0.984807753)
    assert schema["description"] == "Slope of the ramp." and schema["unit"] == "degrees"
    assert schema["exclusiveMaximum"] == 90.0
    assert "tools.ramp.slope" in told and "100.0" in told
    assert "| `Ramp(slope, [foot])` | Half-space under a plane that rises along x |" in table


def test_the_table_of_the_docs_is_that_of_the_classes():
    assert subprocess.run([sys.executable, TOOLS / "tool_table.py", "--check"], check=False).returncode == 0
