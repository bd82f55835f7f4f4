"""What docs/where-does-it-go.md says of an addition is all that it takes: each is made in a copy of the package."""

import pytest


@pytest.fixture
def addition(package_copy, strip):
    """The copy, with a deck beside it."""
    (package_copy.folder / "deck.toml").write_text(strip)
    return package_copy


PLANAR = '''

@dataclass(frozen=True)
class Planar(YieldFunction):
    """A sheet that is isotropic in its plane."""

    r: Positive
    """r-value of all directions."""

    directional = False

    def __post_init__(self) -> None:
        check_fields(self)

    def function(self) -> _core.YieldFunction:
        """The function as the kernels take it."""
        return Hill48(r0=self.r, r45=self.r, r90=self.r).function()


'''


def test_a_yield_function_is_a_class(addition):
    addition.put(
        "materials/yield_functions.py", "@dataclass(frozen=True)\nclass Transformation(ParametersInNotebook):", PLANAR
    )
    addition.run("""
import json
from pathlib import Path

import numpy as np
import umform as uf
from umform.problem import DeckError, Problem
from umform.problem.contents import json_schema
from umform.problem.keys import law_keys

assert np.allclose(uf.sheet_metals.uniaxial(uf.Planar(2.0), 30.0)[1], 2.0)
metal = uf.Metal(210e3, 0.3, hardening=uf.Linear(200.0, 1000.0), yield_function=uf.Planar(2.0))
assert law_keys(metal)["yield_function"] == {"function": "Planar", "r": 2.0}
law = 'law = "Metal"\\nhardening = { curve = "Linear", yield_stress = 200.0, modulus = 1000.0 }'
law += '\\nyield_function = { function = "Planar", r = 2.0 }'
text = Path("deck.toml").read_text().replace('law = "SVK"', law)
built = Problem.read(text).build()
assert built.model.bodies.only.material == metal
assert json.loads(json_schema())["$defs"]["Planar"]["properties"]["r"]["description"] == "r-value of all directions."
try:
    Problem.read(text.replace("r = 2.0", "r = -2.0"))
    raise AssertionError
except DeckError as error:
    assert "yield_function.r" in str(error), error
""")


SLOW = '''@dataclass(frozen=True)
class Slow(RateFactor):
    """A factor that grows little."""

    reference: Annotated[float, Gt(0.0), _TYPICAL]
    """Plastic strain rate from which it grows."""

    def __post_init__(self) -> None:
        check_fields(self)

    def factor(self) -> _core.RateFactor:
        """The factor as the kernels take it."""
        return JohnsonCook(reference=self.reference, strength=0.001).factor()


'''
CARD = """[X1]
number = "9.9999"
young = 210e3
poisson = 0.3
yield_stress = 200
tensile_strength = 300
curve = "Swift"
uniform = "n"
n = 0.15
basis = "invented"
source = "a test"
caveat = "there is no such metal"

"""


def test_a_rate_factor_is_a_class_and_a_sheet_metal_a_table(addition):
    addition.put("materials/rate_factor.py", "@dataclass(frozen=True)\nclass JohnsonCook(", SLOW)
    addition.put("sheet_metals/metals.toml", "[S235]", CARD)
    addition.run("""
import json
from pathlib import Path

import umform as uf
from typer.testing import CliRunner
from umform.cli import app
from umform.problem import Problem
from umform.problem.contents import json_schema
from umform.problem.keys import law_keys

metal = uf.Metal(210e3, 0.3, hardening=uf.Linear(200.0, 1000.0), rate=uf.Slow(2.0))
assert law_keys(metal)["rate"] == {"factor": "Slow", "reference": 2.0}
law = 'law = "Metal"\\nhardening = { curve = "Linear", yield_stress = 200.0, modulus = 1000.0 }'
law += '\\nrate = { factor = "Slow", reference = 2.0 }'
text = Path("deck.toml").read_text()
assert Problem.read(text.replace('law = "SVK"', law)).build().model.bodies.only.material == metal
part = json.loads(json_schema())["$defs"]["Slow"]["properties"]["reference"]
assert part["description"] == "Plastic strain rate from which it grows."

shown = CliRunner().invoke(app, ["metal", "list"])
assert "X1" in shown.stdout, shown.output
assert 200.0 < uf.sheet_metals.get("X1").law.hardening.curve()(0.05)[0] < 330.0
done = CliRunner().invoke(app, ["bend", "--stroke", "1", "--material", "X1", "--print-deck"])
assert done.exit_code == 0, done.output
""")


EXTENT = '''class Extent(MeasurePart):
    """Extent of the part along x."""

    kind: Literal["extent"]
    factor: Positive = 1.0
    """Factor of the extent."""

    def take(self, name: str, part: Formed) -> Measured:
        """The extent in each state."""
        from umform.plotting import Picture

        wide = {state: self.factor * float(np.ptp(part.places(state)[:, 0])) for state in part.states}
        curve = {"x": part.places(part.last)[:, 0]}
        return Measured([in_states("extent", part.units.length, **wide)], curve, Picture, "Nothing.")


'''


def test_a_measure_of_a_deck_is_a_table(addition):
    addition.put("problem/measures/curves.py", "class Ears(MeasurePart)", EXTENT)
    addition.put("problem/measures/__init__.py", "DrawIn, Ears, SectionCurve", "Extent, ")
    addition.put("problem/measures/__init__.py", "SectionCurve | Springback", "Extent | ")
    addition.run("""
import csv, json
from pathlib import Path

from typer.testing import CliRunner
from umform.cli import app
from umform.problem.contents import json_schema

with open("deck.toml", "a") as file:
    file.write('[measures.size]\\nkind = "extent"\\nfactor = 2.0\\n')
done = CliRunner().invoke(app, ["run", "deck.toml", "--out", "out"])
assert done.exit_code == 0, done.output
(row,) = csv.DictReader(Path("out/measures.csv").open())
assert row["quantity"] == "extent" and abs(float(row["formed"]) - 20.2) < 1e-9, row
assert len(Path("out/measure-size.csv").read_text().splitlines()) == 31
part = json.loads(json_schema())["$defs"]["Extent"]["properties"]["factor"]
assert part["description"] == "Factor of the extent." and part["default"] == 1.0
""")


def test_a_column_of_every_history_is_a_line(addition):
    addition.put("model/terms/controls.py", '    "external_work",\n', '    "farthest",\n')
    line = '        row["farthest"] = float(np.abs(model.u).max())\n'
    addition.put("results/history.py", "        row |= self._energy_columns(evaluation)\n", line)
    addition.run("""
import csv
from pathlib import Path

from typer.testing import CliRunner
from umform.cli import app
from umform.errors import UmformError
from umform.problem import Problem

done = CliRunner().invoke(app, ["run", "deck.toml", "--out", "out"])
assert done.exit_code == 0, done.output
rows = list(csv.DictReader(Path("out/history.csv").open()))
assert [round(float(row["farthest"]), 9) for row in rows] == [0.0, 0.05, 0.1], rows
try:
    Problem.read(Path("deck.toml").read_text().replace("pull", "farthest")).build()
    raise AssertionError
except UmformError as error:
    assert "column 'farthest' of the history itself" in str(error), error
""")


FIELD = """    fields["far_x"] = model.u.reshape(-1, 3)[model.mesh.connectivity, 0].max(axis=1)
"""
TRIES = '''    tries: Count = 3
    """Number of tries."""

'''


def test_a_field_of_the_results_and_an_option_are_a_line(addition):
    addition.put("results/fields.py", "    return fields\n\n\ndef _cell_fields(", FIELD)
    addition.put(
        "analysis/newton/options.py", "    def __post_init__(self) -> None:\n        check_fields(self)", TRIES
    )
    addition.run("""
import json
from pathlib import Path

import umform as uf
from typer.testing import CliRunner
from umform.cli import app
from umform.problem import DeckError, Problem
from umform.problem.contents import json_schema

assert uf.NewtonOptions(tries=4).tries == 4
text = Path("deck.toml").read_text()
assert Problem.read(text + '[solution]\\ntries = 5\\n').build().options.tries == 5
key = json.loads(json_schema())["$defs"]["Solution"]["properties"]["tries"]
assert (key["default"], key["minimum"], key["description"]) == (3, 1, "Number of tries.")
try:
    Problem.read(text + '[solution]\\ntries = 0\\n')
    raise AssertionError
except DeckError as error:
    assert "solution.tries" in str(error), error

result = Problem.read(text).build().solve(progress=False)
assert abs(result.frames[-1].cells["far_x"].max() - 0.1) < 1e-12
done = CliRunner().invoke(app, ["run", "deck.toml", "--out", "out"])
assert done.exit_code == 0, done.output
assert b"far_x" in Path("out/fields.vtkhdf").read_bytes()
""")


STEP = '''"""Move a control back by a part of its value in each increment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from umform.analysis.steps.increment import take_increment
from umform.analysis.steps.run_state import Run, Take
from umform.model.terms.control import Control
from umform.spec import check_fields
from umform.spec.types import Increments, Share


@dataclass(frozen=True)
class Fade:
    """Reduce a control by the same part of its value in each increment."""

    control: Control
    """What fades."""
    part: Share = 0.5
    """Part of its value that an increment takes away."""
    steps: Increments = 3
    """Number of increments."""

    def __post_init__(self) -> None:
        check_fields(self)

    def moved(self) -> list[Control]:
        """The control of the step."""
        return [self.control]


@dataclass
class Fading:
    """Its loop."""

    start: float
    count: int = 0
    done: bool = False

    @classmethod
    def begin(cls, run: Run, step: Fade) -> Self:
        """The loop at the beginning of the step."""
        return cls(run.model.system.time)

    @classmethod
    def recall(cls, run: Run, step: Fade, memory: dict[str, Any]) -> Self:
        """The restored loop."""
        return cls(**memory)

    def memory(self) -> dict[str, Any]:
        """State of the loop, for checkpoints."""
        return dict(vars(self))

    def _next(self, step: Fade) -> tuple[list[float], list[Control], float]:
        self.count += 1
        self.done = self.count == step.steps
        value = (1.0 - step.part) * step.control.value
        return [value], step.moved(), self.start + self.count / step.steps

    def advance(self, run: Run, step: Fade) -> None:
        """One increment."""
        values, moved, time = self._next(step)
        converged = take_increment(run, values, moved, time, None)
        run.keep(converged, moved, name="fade", fraction=self.count / step.steps, frame=self.done)

    def follow(self, run: Run, step: Fade, lead: Run, take: Take) -> None:
        """Repeat the last accepted increment of another run."""
        take(*self._next(step))
'''
STEP_TABLE = '''class Fade(_Controlled, of=steps.Fade, leave=("control",), called={"steps": "increments"}):
    """Reduce a control by the same part of its value in each increment."""

    kind: Literal["fade"]

    def build(self, named: Named) -> steps.Step:
        """The step."""
        return steps.Fade(named.controls[self.control], **self.of_spec())

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return int(self.of_spec()["steps"])


'''


def test_a_step_is_a_dataclass_and_its_loop(addition):
    """It runs, stops, goes on and is followed by shadows."""
    addition.write("analysis/steps/fade.py", STEP)
    addition.put(
        "analysis/steps/__init__.py", "from umform.analysis.steps.free", "from umform.analysis.steps.fade import Fade\n"
    )
    addition.put("analysis/steps/__init__.py", "Move | Release", "Fade | ")
    addition.put(
        "analysis/run/run_steps.py",
        "from umform.analysis.steps.free",
        "from umform.analysis.steps.fade import Fade, Fading\n",
    )
    addition.put("analysis/run/run_steps.py", "Release: Releasing", "Fade: Fading, ")
    addition.put("problem/steps.py", "class Close(_Controlled", STEP_TABLE)
    addition.put("__init__.py", '"Arc", "Close", "Free", "Move"', '"Fade", ')
    addition.put("problem/steps.py", "Move | Release | Arc | Free", "Fade | ")
    addition.run("""
import json
from pathlib import Path

import numpy as np
import umform as uf
from typer.testing import CliRunner
from umform.cli import app
from umform.problem.contents import json_schema
from umform.problem.problem import load

with open("deck.toml", "a") as file:
    file.write('[[steps]]\\nkind = "fade"\\ncontrol = "pull"\\npart = 0.25\\nincrements = 4\\n')
for command in (["check", "deck.toml"], ["run", "deck.toml", "--out", "out"]):
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output

problem = load("deck.toml")
built = problem.build()
result = built.solve(progress=False)
assert built.steps[1] == uf.Fade(built.controls["pull"], part=0.25, steps=4) and "Fade" in dir(uf)
assert np.allclose(result["pull"][3:], 0.1 * 0.75 ** np.arange(1, 5)), result["pull"]
assert np.allclose(result["time"], [0, 0.5, 1, 1.25, 1.5, 1.75, 2])
keys = json.loads(json_schema())["$defs"]["Fade"]["properties"]
assert keys["increments"]["default"] == 3 and keys["part"]["maximum"] == 1.0

parts = iter("12345")
def stop(*args):
    if next(parts) == "5":
        raise KeyboardInterrupt
other = problem.build()
try:
    uf.solve(other.model, other.steps, progress=stop, checkpoint="kept.h5", every=0.0)
    raise AssertionError
except KeyboardInterrupt as error:
    assert 4 < len(error.result.rows) < 7, len(error.result.rows)
again = problem.build()
resumed = uf.resume("kept.h5", again.model, again.steps, progress=False)
assert np.array_equal(resumed["pull_force"], result["pull_force"])

found = uf.derivatives(problem, ["steps.1.part"], ["pull:last"], progress=False)
assert np.allclose(found.values, -0.4 * 0.75**3, rtol=1e-4), found.values  # a difference of first order
""")


ELEMENT = '''def _layered(**options: Any) -> Element:
    """ANS3DEAS with its shear tied at the layers."""
    ans = CATALOGUE["ANS3DEAS"](**options)
    tying = tuple(replace(row, at_layer=row.component != "33") for row in ans.tying)
    return replace(ans, name="LAYERED", tying=tying)


'''


def test_an_element_is_a_function_and_a_line(addition):
    addition.put("elements/catalogue.py", "#: The catalogue: name", ELEMENT)
    addition.put("elements/catalogue.py", "import math\n", "from dataclasses import replace\n")
    addition.put("elements/catalogue.py", '    "DISP9K3D": _build(', '    "LAYERED": _layered,\n')
    addition.run("""
import json
from pathlib import Path

import umform as uf
from typer.testing import CliRunner
from umform.cli import app
from umform.problem import Problem
from umform.problem.contents import json_schema

assert uf.elements.element("LAYERED", tie_E33=True).tying[-1].component == "33"
assert uf.check_element("LAYERED").zeros == 6
text = Path("deck.toml").read_text() + '[element]\\nname = "LAYERED"\\nthickness_modes = 1\\n'
built = Problem.read(text).build()
assert built.model.bodies.only.element.name == "LAYERED"
assert built.solve(progress=False)["pull_force"][-1] > 0.0
assert "LAYERED" in json_schema()
shown = CliRunner().invoke(app, ["elements"]).stdout
(row,) = [line.split() for line in shown.splitlines() if "LAYERED" in line]
assert row == ["LAYERED", "8", "E13", "E23", "4", "E33", "HauptmannSchweizerhof1998"], row
""")


SOLVER = '''"""A dense matrix."""

from __future__ import annotations

import numpy as np

from .protocol import Factorisation, FloatArray, Pattern


class Dense:
    """Inverse of the full matrix."""

    name = "dense"

    def analyse(self, pattern: Pattern) -> None:
        """Keep the pattern."""
        self._pattern = pattern

    def factor(self, values: FloatArray) -> Factorisation:
        """Invert the matrix."""
        full = np.zeros((self._pattern.n, self._pattern.n))
        full[self._pattern.rows, self._pattern.indices] = self._pattern.checked(values)
        if self._pattern.symmetric:
            full += np.triu(full, 1).T
        self._inverse = np.linalg.inv(full)
        return Factorisation(int((np.linalg.eigvalsh(full) < 0.0).sum()), full.size)

    def solve(self, rhs: FloatArray) -> FloatArray:
        """The solution."""
        found: FloatArray = self._inverse @ self._pattern.checked_rhs(rhs)
        return found
'''


def test_a_solver_is_a_file_and_a_line(addition):
    addition.write("solvers/dense.py", SOLVER)
    addition.put("solvers/__init__.py", "from .multifrontal import", "from .dense import Dense\n")
    addition.put("solvers/__init__.py", '    "pardiso": _pardiso,', '    "dense": Dense,\n')
    addition.run("""
import json
from pathlib import Path

import numpy as np
from typer.testing import CliRunner
from umform import solvers
from umform.cli import app
from umform.problem import Problem

assert solvers.available()["dense"]
text = Path("deck.toml").read_text()
other = Problem.read(text).build().solve(progress=False)
Path("dense.toml").write_text(text + '[solution]\\nsolver = "dense"\\n')
done = CliRunner().invoke(app, ["run", "dense.toml", "--out", "out"])
assert done.exit_code == 0, done.output
result = Problem.read(Path("dense.toml").read_text()).build().solve(progress=False)
assert result.solver == "dense"
assert np.allclose(result["pull_force"], other["pull_force"], rtol=1e-9)
""")


COMMAND = '''"""``umform weigh``: the weight of a strip."""

from __future__ import annotations

from typing import Annotated

import typer

from umform.cli.root import app
from umform.errors import InvalidValue


@app.command()
def weigh(length: Annotated[float, typer.Option(help="Length in mm.")] = 100.0) -> None:
    """Weigh a strip of steel."""
    if length <= 0.0:
        raise InvalidValue("the length must be positive", where="length", value=length)
    typer.echo(f"{7.85e-3 * length:.3f} g for each mm2")
'''


def test_a_command_is_a_file_and_its_name(addition):
    addition.write("cli/weigh.py", COMMAND)
    addition.put("cli/commands.py", '    "view": "view",', '    "weigh": "weigh",\n')
    help_of_all, help_of_it, said, refused = (
        addition.umform(*words) for words in (["--help"], ["weigh", "--help"], ["weigh"], ["weigh", "--length", "-1"])
    )
    assert "Weigh a strip of steel." in help_of_all.stdout and help_of_all.returncode == 0
    assert "Length in mm." in help_of_it.stdout and help_of_it.returncode == 0
    assert said.stdout == "0.785 g for each mm2\n"
    assert refused.returncode == 1 and "the length must be positive" in refused.stderr
    assert "--length" in refused.stderr and "Traceback" not in refused.stderr


def test_a_number_of_a_process_is_a_field_and_its_value(addition):
    field = '''    steady_way: Annotated[float, Quantity("steady travel", "mm", 2)]
    """Travel over which the forces are averaged."""
'''
    addition.put("processes/draw_bead/measures.py", "    closing_force: Annotated", field)
    value = "            steady_way=float(np.ptp(way[steady])),\n"
    addition.put("processes/draw_bead/measures.py", "            closing_force=", value)
    addition.run("""
import csv
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import umform as uf
from umform.cli.outcome_screen import show_outcome
from umform.processes.draw_bead import DrawBead, drawn_through

steel = uf.J2(210e3, 0.3, hardening=uf.Linear(200.0, 500.0))
coarse = {"element": "ANS3DEAS", "elements": 2, "contact_points": 3}
case = DrawBead(thickness=1.0, material=steel, radius=3.0, height=1.0, groove_radius=3.0, **coarse)
drawn = drawn_through(case, frames=0, progress=False)
way = drawn["steady_way"].value
assert 0.0 < case.way - case.through - way < case.size
assert [one["unit"] for one in drawn.record()["quantities"] if one["name"] == "steady_way"] == ["mm"]
drawn.write(Path("."))
(row,) = [row for row in csv.DictReader(Path("quantities.csv").open()) if row["name"] == "steady_way"]
assert row["unit"] == "mm" and float(row["value"]) == way
with redirect_stdout(StringIO()) as screen:
    show_outcome(drawn, note="", everything=True)
assert "steady travel" in screen.getvalue() and f"{way:.2f}" in screen.getvalue()
""")


SPEC = '''"""A strip that is pulled: its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from umform.spec import check_fields
from umform.spec.types import Length, Stress


@dataclass(frozen=True, kw_only=True)
class Pull:
    """A strip that is pulled, in mm, N and MPa."""

    groups: ClassVar = {"length": "Sheet", "way": "Solution"}
    """Group of the parameters from each of these on."""

    length: Length = 10.0
    """Length of the strip."""
    young: Stress = 210e3
    """Young's modulus."""
    way: Length = 0.1
    """Travel of its end."""

    def __post_init__(self) -> None:
        check_fields(self)
'''
PROBLEM = '''"""The problem of a strip that is pulled: what a deck of it holds."""

from __future__ import annotations

from umform.problem.problem import Problem
from umform.processes.pull.spec import Pull


def problem_of(case: Pull) -> Problem:
    """One end is held, the other one is pulled."""
    cells = {"generator": "strip", "width": 2.0, "thickness": 1.0, "cells": (4, 1)}
    tables = {
        "title": "A strip that is pulled",
        "mesh": {"length": case.length, **cells},
        "material": {"law": "SVK", "E": case.young, "nu": 0.0},
        "supports": [{"kind": "fix", "nodes": "x0"}],
        "controls": {"pull": {"kind": "displacement", "nodes": "x1", "direction": "x"}},
        "steps": [{"kind": "move", "to": {"pull": case.way}, "increments": 2}],
    }
    return Problem.of(tables, ["Units: mm, N, MPa."])
'''
MEASURES = '''"""Measures of a strip that was pulled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from umform.analysis.run import Result
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity, quantities_of


@dataclass(frozen=True)
class Pulled(Outcome):
    """A strip that was pulled."""

    result: Result
    force: Annotated[float, Quantity("force", "N", 1)]
    """Force at the end of the travel."""

    title = "A strip that was pulled"

    @property
    def quantities(self) -> list[Quantity]:
        """The measures."""
        return quantities_of(self)

    @property
    def stages(self) -> dict[str, Result]:
        """The run by its name."""
        return {"pulling": self.result}

    @property
    def warnings(self) -> list[str]:
        """Warnings."""
        return self.result.warnings
'''
OUTCOME = '''"""What is reported of a run."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.processes.pull.measures import Pulled
from umform.processes.pull.spec import Pull


def outcome_of(case: Pull, result: Result) -> Pulled:
    """The force."""
    return Pulled(result, float(result["pull_force"][-1]))
'''
PULL = '''"""``umform pull``: pull a strip."""

from __future__ import annotations

from umform.cli.spec_options import Given, given_by
from umform.cli.options import PrintDeck, print_deck
from umform.cli.outcome_screen import show_outcome
from umform.cli.root import app
from umform.processes.pull.spec import Pull


@app.command()
@given_by(Pull)
def pull(given: Given, deck: PrintDeck = False) -> None:
    """Pull a strip."""
    from umform.processes.problems import outcome_of, problem_of

    case = Pull(**given)
    if deck:
        print_deck(case)
        return
    show_outcome(outcome_of(case, problem_of(case).build().solve(progress=False)), note="", everything=True)
'''


def test_a_process_is_a_folder_and_its_command(addition):
    """Its Spec gives options, checks and parameters of derivatives; its deck is the same run."""
    files = {"__init__": '"""A strip that is pulled."""\n', "spec": SPEC, "problem": PROBLEM}
    for name, text in (files | {"measures": MEASURES, "outcome": OUTCOME}).items():
        addition.write(f"processes/pull/{name}.py", text)
    addition.write("cli/pull.py", PULL)
    addition.put("cli/commands.py", '    "resume": "resume",', '    "pull": "pull",\n')
    addition.run("""
import re

import numpy as np
import umform as uf
from typer.testing import CliRunner
from umform.cli import app
from umform.problem import Problem
from umform.processes.problems import outcome_of, problem_of
from umform.processes.pull.spec import Pull

def umform(*words):
    return CliRunner().invoke(app, ["pull", *words], env={"COLUMNS": "200", "TERMINAL_WIDTH": "200"})

assert re.search(r"--way\\s+<float>\\s+Travel of its end in mm\\.", umform("--help").stdout), umform("--help").stdout
refused = umform("--way", "-1")
assert refused.exit_code == 1 and "--way" in refused.output and "positive" in refused.output, refused.output

case = Pull(length=20.0)
result = problem_of(case).build().solve(progress=False)
done = outcome_of(case, result)
assert f"{done['force'].value:.1f}" in umform("--length", "20").stdout
deck = Problem.read(umform("--length", "20", "--print-deck").stdout)
assert np.array_equal(deck.build().solve(progress=False)["pull_force"], result["pull_force"])

found = uf.derivatives(case, ["young", "way", "length"], progress=False)
force = done["force"].value
assert [one.name for one in found.responses] == ["force"] and found.responses[0].value == force
by_young, by_way, by_length = found.values[0] * [case.young, case.way, case.length] / force
assert abs(by_young - 1.0) < 1e-3
assert abs(by_way + by_length) < 1e-3  # the strain is all that counts
assert 1.0 < by_way < 1.1  # and its force grows a little faster than it
""")
