"""What docs/where-does-it-go.md says of a generator, a support and a control is all: a function, and its table."""

import json

import pytest

#: File of the package, a text that occurs there once, and what is put before it.
ADDED = [
    (
        "mesh/generators.py",
        "#: A plate is a wide strip.",
        '''
def wedge(length: Positive, cells: Divisions, *, cell: str = "hex8", rise: Positive = 0.25) -> Mesh:
    """A strip that rises.

    Parameters
    ----------
    length : float
        Along x.
    cells : int
        Elements along x.
    rise : float
        Rise of the strip; z at its end.
    """
    check_arguments(wedge, rise=rise)
    flat = strip(length, 1.0, 0.2, (cells, 1), cell=cell)
    return flat.transformed(lambda X: X + np.outer(X[:, 0] / length, (0.0, 0.0, rise)))


''',
    ),
    ("mesh/__init__.py", '    "together",\n]', '    "wedge",\n'),
    ("mesh/__init__.py", "from umform.mesh.mesh import", "from umform.mesh.generators import wedge\n"),
    (
        "problem/mesh.py",
        "class Grid(Part",
        '''class Wedge(Part, of=mesh.wedge, leave=("cell",)):
    """A strip that rises."""

    generator: Literal["wedge"]

    def build(self, cell: str, folder: Path) -> Mesh:
        """The mesh."""
        return mesh.wedge(cell=cell, **self.of_spec())


''',
    ),
    ("problem/mesh.py", '    | Annotated[Grid, Tag("grid")]', '    | Annotated[Wedge, Tag("wedge")]\n'),
    (
        "model/supports/supports.py",
        "    def hinge(\n",
        '''    def hold_edge(self, nodes: Selector, directions: str = "xz", name: str = "") -> Support:
        """Hold an edge.

        Parameters
        ----------
        directions : str
            Letters of the directions that are held.
        """
        return self.fix(nodes, directions, name=name)

''',
    ),
    (
        "problem/supports.py",
        "class Symmetry(Part",
        '''class Edge(Part, of=Supports.hold_edge, leave=("nodes", "name")):
    """A held edge."""

    kind: Literal["edge"]
    nodes: Selection
    """Which nodes."""

    def add_to(self, model: Model, *, here: bool = False) -> Held:
        """Hold the edge."""
        return model.supports.hold_edge(nodes_of(model.mesh, self.nodes), **self.of_spec())


''',
    ),
    ("problem/supports.py", "Fix | Symmetry | Hinge", "Edge | "),
    (
        "model/terms/loads.py",
        "    def line_load(",
        '''    def hang(self, nodes: Selector, mass: Annotated[float, Gt(0.0), Le(9.5)] = 2.5, name: str = "") -> Load:
        """Hang weights on nodes.

        Parameters
        ----------
        mass : float
            Mass on each node; it hangs
            for the value 1.
        """
        return self.force(nodes, (0.0, 0.0, -9.81 * mass), name)

''',
    ),
    (
        "model/terms/loads.py",
        "import numpy as np\n",
        "from typing import Annotated\n\nfrom annotated_types import Gt, Le\n",
    ),
    (
        "problem/controls.py",
        "class _OfTool(Part)",
        '''class Weights(Part, of=Loads.hang, leave=("nodes", "name")):
    """Weights on nodes."""

    kind: Literal["weights"]
    nodes: Selection
    """Which nodes."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.loads.hang(nodes_of(model.mesh, self.nodes), name=name, **self.of_spec())


''',
    ),
    ("problem/controls.py", "    | Drive\n", "    | Weights\n"),
]
DECK = """
[mesh]
generator = "wedge"
length = 10.0
cells = 4
[material]
law = "SVK"
E = 210e3
nu = 0.3
[[supports]]
kind = "edge"
nodes = "x0"
[[supports]]
kind = "fix"
nodes = "x0"
directions = "y"
[controls.load]
kind = "weights"
nodes = "x1"
[[steps]]
kind = "move"
to = { load = 1.0 }
increments = 1
"""
PROGRAM = """
import json
from pathlib import Path

from umform.errors import UmformError
from umform.problem.contents import json_schema
from umform.problem.problem import load

built = load("deck.toml").build()
result = built.solve(progress=False)
forces = built.controls["load"].vector.reshape(-1, 3)[:, 2]
refused = ""
Path("heavy.toml").write_text(Path("deck.toml").read_text().replace('"weights"', '"weights"\\nmass = 9.6'))
try:
    load("heavy.toml")
except UmformError as error:
    refused = str(error)
schema = json.loads(json_schema())["$defs"]
kinds = {"Wedge": "rise", "Edge": "directions", "Weights": "mass"}
keys = [schema[kind]["properties"][key] for kind, key in kinds.items()]
top, sinks = float(built.model.mesh.points[:, 2].max()), bool((result.model.u[2::3] < 0.0).any())
print(json.dumps([top, float(forces.min()), sinks, refused, keys]))
"""


def test_a_generator_a_support_and_a_control_are_a_function_and_its_table(package_copy):
    """Default, bound and sentence stand in the function; the deck builds and runs, and its schema has them."""
    for addition in ADDED:
        package_copy.put(*addition)
    (package_copy.folder / "deck.toml").write_text(DECK)
    top, load, sinks, refused, (rise, directions, mass) = json.loads(package_copy.run(PROGRAM))
    assert top == pytest.approx(0.25 + 0.1) and load == pytest.approx(-9.81 * 2.5) and sinks
    assert "mass" in refused and "9.5" in refused
    assert (rise["default"], rise["exclusiveMinimum"]) == (0.25, 0)
    assert rise["description"] == "Rise of the strip; z at its end."
    assert directions["default"] == "xz" and directions["description"] == "Letters of the directions that are held."
    assert (mass["default"], mass["maximum"]) == (2.5, 9.5)
    assert mass["description"] == "Mass on each node; it hangs for the value 1."
