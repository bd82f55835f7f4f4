"""Specs: what a field declares is what every front end says and checks."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from inspect import Parameter, signature
from typing import Annotated, ClassVar, Literal

import pytest
import typer
from annotated_types import Ge, Le
from pydantic import TypeAdapter, ValidationError
from typer.testing import CliRunner

import umform as uf
from umform.cli.spec_options import Given, given_by
from umform.errors import InvalidValue, NotFinite
from umform.model.contact import ContactOptions
from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.spec import Bend, BendSequence, Bodies
from umform.processes.bending.spec import FreeBending
from umform.processes.draw.cup import Cup
from umform.processes.draw.u_bend import UBend
from umform.processes.draw_bead.spec import DrawBead
from umform.processes.hemming import Hemming
from umform.spec import About, Rule, check_arguments, check_fields, parameters, scalars, takes
from umform.spec.types import Degrees, Length


@dataclass(frozen=True)
class Tube:
    """A tube."""

    groups: ClassVar = {"radius": "Tube", "points": "Solution"}

    radius: Length = 20.0
    """Radius of the tube, to its middle."""
    wall: Length | None = None
    """Thickness of the wall; without it, a tenth
    of the radius."""
    bend: Degrees = 90.0
    """Angle of the bend."""
    points: Annotated[int, Ge(1), Le(10)] | Literal["auto"] = "auto"
    """Contact points: of a facet."""
    part: Annotated[float, Rule(lambda value: value != 0.5, "not half of it", "a half", "another part")] = 1.0
    """Part that is modelled."""
    hollow: bool = True
    """Whether it is hollow."""

    def __post_init__(self) -> None:
        check_fields(self)


@pytest.mark.parametrize(
    ("values", "text", "remedy"),
    [
        ({"radius": 0.0}, "the radius of the tube must be positive and finite", "in mm, such as 20"),
        ({"radius": "20"}, "the radius of the tube must be positive and finite", "in mm, such as 20"),
        ({"radius": True}, "the radius of the tube must be positive and finite", "in mm, such as 20"),
        ({"wall": -1.0}, "the thickness of the wall must be positive and finite", "in mm; or leave it out"),
        ({"bend": 180.0}, "the angle of the bend must be a number between 0 and 180", "in degrees, such as 90"),
        ({"points": 11}, "the contact points must be a whole number from 1 to 10 or auto", "a whole number"),
        ({"points": 2.5}, "the contact points must be a whole number from 1 to 10 or auto", "a whole number"),
        ({"points": "all"}, "the contact points must be a whole number from 1 to 10 or auto", "a whole number"),
        ({"part": 0.5}, "not half of it", "another part"),
        ({"radius": None}, "the radius of the tube must be positive and finite", "in mm, such as 20"),
        ({"hollow": 1}, "hollow must be true or false", "true or false"),
    ],
)
def test_an_invalid_value_is_refused_in_the_words_of_its_field(values, text, remedy):
    with pytest.raises(InvalidValue) as refusal:
        Tube(**values)
    assert refusal.value.what == text
    assert refusal.value.remedy.startswith(remedy) and refusal.value.where == next(iter(values))


def test_a_number_that_is_not_finite_is_refused_as_such():
    with pytest.raises(NotFinite):
        Tube(radius=math.nan)


def test_valid_values_are_accepted():
    assert Tube(points=3, wall=2, bend=179.9).points == 3


def test_units_stand_behind_the_first_clause():
    texts = {name: parameter.text for name, parameter in parameters(Tube).items()}
    assert texts["radius"] == "Radius of the tube in mm, to its middle."
    assert texts["wall"] == "Thickness of the wall in mm; without it, a tenth of the radius."
    assert texts["points"] == "Contact points: of a facet."


def test_a_command_has_an_option_for_each_field():
    app, got = typer.Typer(), {}

    @app.command()
    @given_by(Tube, omit=["part"], radius=30.0)
    def tube(given: Given, out: str = "here") -> None:
        """Bend a tube."""
        got.update(given, out=out)

    shown = CliRunner().invoke(app, ["--help"], env={"COLUMNS": "200"}).output
    for text in ("Bend a tube.", "Thickness of the wall in mm;", "[default: 30.0]", "─ Tube ─", "─ Solution ─"):
        assert text in shown
    assert "--part" not in shown and "--given" not in shown
    assert CliRunner().invoke(app, ["--points", "4", "--wall", "2.5", "--no-hollow"]).exit_code == 0
    assert got == {"radius": 30.0, "wall": 2.5, "bend": 90.0, "points": 4, "hollow": False, "out": "here"}
    assert Tube(**{name: got[name] for name in ("radius", "wall", "points")}).points == 4


def test_an_option_may_have_another_name_and_no_default():
    app, got = typer.Typer(), {}

    @app.command()
    @given_by(Tube, called={"hollow": "--full/--empty", "radius": "--size"}, points=None, wall=2.0)
    def tube(given: Given) -> None:
        """Bend a tube."""
        got.update(given)

    assert CliRunner().invoke(app, ["--size", "25", "--full"]).exit_code == 0
    assert got == {"radius": 25.0, "wall": 2.0, "bend": 90.0, "points": None, "part": 1.0, "hollow": True}


def test_the_schema_of_pydantic_has_the_same_bounds_and_units():
    schema = TypeAdapter(Tube).json_schema()["properties"]
    assert schema["radius"] == {
        "exclusiveMinimum": 0.0,
        "type": "number",
        "unit": "mm",
        "default": 20.0,
        "title": "Radius",
    }
    assert json.loads(json.dumps(schema["bend"]))["exclusiveMaximum"] == 180.0
    with pytest.raises(ValidationError, match="greater than 0"):
        TypeAdapter(Tube).validate_python({"radius": -1.0})


#: Ratios and counts, and the penalty of air bending.
WITHOUT_UNIT = ("elements_per_thickness", "increment", "penalty", "elements", "friction")


@pytest.mark.parametrize(
    "spec", [AirBending, Bend, BendSequence, Bodies, Cup, DrawBead, FreeBending, Goal, Hemming, UBend]
)
def test_each_field_of_a_process_has_a_sentence_and_each_number_a_reason(spec):
    for name, parameter in parameters(spec).items():
        assert parameter.sentence.endswith(".") and parameter.sentence[0].isupper(), name
        if parameter.kinds[0].type is float:
            assert parameter.about.unit or name in WITHOUT_UNIT, name


def test_the_outer_description_covers_the_inner_one():
    @dataclass(frozen=True)
    class Own:
        length: Annotated[Length, About(remedy="as on the drawing")] = 1.0
        """Length."""

    about = parameters(Own)["length"].about
    assert (about.unit, about.remedy) == ("mm", "as on the drawing")


@pytest.mark.parametrize("name", ["sheet", "bodies"])
def test_nothing_in_place_of_an_object_is_refused(name):
    with pytest.raises(InvalidValue, match="must be an object"):
        BendSequence(length=80.0, bends=(Bend(position=40.0, angle=90.0),), **{name: None})


@dataclass(frozen=True)
class Holder:
    """A holder."""

    thing: object
    """Thing that it holds."""


def test_nothing_in_place_of_any_object_is_refused():
    check_fields(Holder(1.0))
    with pytest.raises(InvalidValue, match="the thing that it holds must be an object"):
        check_fields(Holder(None))


def test_a_whole_number_of_a_field_for_any_number_can_vary():
    found = {one.path: one.value for one in scalars(AirBending(thickness=2, layers=2, contact_points=5))}
    kinds = {path: type(found[path]) for path in ("thickness", "layers", "contact_points")}
    assert kinds == {"thickness": float, "layers": int, "contact_points": int}


def test_a_signature_names_the_fields_of_its_options():
    """Of methods whose options are a Spec: names, order and defaults."""
    contact = signature(uf.Model.contact).parameters
    assert list(contact) == ["self", "faces", "tool", "name", *parameters(ContactOptions)]
    assert contact["augmented"].default is False
    bead = signature(uf.Model.bead).parameters
    assert bead["restraint"].default is Parameter.empty and list(bead).count("curve") == 1
    assert signature(uf.Model).parameters["thickness_points"].default is None


def rolled(x: float, turns: Annotated[int, Ge(1)] = 2, *, wall: Length | None = None, **more: object) -> None:
    """Roll a tube.

    Parameters
    ----------
    x : float
        Place,
        along the axis.
    turns : int
        Number of turns.
    wall : float, optional
        Thickness of the wall; without it, a tenth
        of the radius.

    Raises
    ------
    InvalidValue
        Always.
    """


def drawn(y: float, turns: int = 3) -> None:
    """Draw a tube.

    Parameters
    ----------
    y, turns : float
        As for :func:`rolled`.
    """


class Mill:
    """A mill."""

    def roll(self, speed: Length) -> None:
        """Roll.

        Parameters
        ----------
        speed : float
            Speed.
        """
        check_arguments(Mill.roll, "mill 3", speed=speed)


def test_the_arguments_of_a_function_are_parameters():
    known = parameters(rolled)
    assert list(known) == ["x", "turns", "wall"] and known["turns"].default == 2
    assert known["x"].sentence == "Place, along the axis."
    assert known["wall"].text == "Thickness of the wall in mm; without it, a tenth of the radius."
    assert known["wall"].optional and known["turns"].must_be == "a whole number of at least 1"
    assert list(parameters(Mill.roll)) == ["speed"]


def test_as_for_another_function_is_its_sentence():
    assert parameters(drawn)["turns"].sentence == "Number of turns."
    assert parameters(drawn)["y"].sentence == "As for :func:`rolled`."


def test_arguments_out_of_bounds_are_refused_where_they_are():
    check_arguments(rolled, turns=1, wall=None)
    with pytest.raises(InvalidValue, match="the number of turns must be a whole number of at least 1") as refused:
        check_arguments(rolled, turns=0)
    assert refused.value.where == "rolled, turns"
    with pytest.raises(InvalidValue) as refused:
        Mill().roll(-1.0)
    assert refused.value.where == "mill 3, speed"


def test_a_function_takes_the_options_of_another_one():
    @takes(rolled, "x")
    def cut(path: str, **how: object) -> None:
        """Cut."""

    assert list(signature(cut).parameters) == ["path", "turns", "wall"]
    assert signature(cut).parameters["turns"].default == 2
    assert "thickness" in signature(uf.mesh.read_shell).parameters
    assert signature(uf.mesh.read_shell).parameters["kink"].default == 100.0


@pytest.mark.parametrize(
    ("name", "start"), [("steps", "the number of"), ("cuts", "how often"), ("time", "the duration")]
)
def test_a_clause_with_an_article_gets_no_other_one(name, start):
    assert parameters(uf.Move)[name].subject.startswith(start)
    assert parameters(uf.Release)["control"].subject.startswith("a prescribed displacement")


def test_a_list_is_shown_as_it_is_and_a_mesh_as_it_is_typed():
    with pytest.raises(InvalidValue) as wrong:
        uf.derivatives(uf.J2, by=[1, 2])
    assert wrong.value.value == "[1, 2]"
    with pytest.raises(InvalidValue) as wrong:
        FreeBending(mesh=(0, 1))
    assert wrong.value.value == "0x1"
