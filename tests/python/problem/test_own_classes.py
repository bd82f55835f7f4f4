"""Classes of the user in a deck: refused without trust, else read like any other, with the same errors and words."""

import sys

import pytest
from typer.testing import CliRunner

import umform as uf
from umform import cli
from umform.problem import DeckError, Problem, load
from umform.problem.keys import law_keys

LAWS = '''
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from annotated_types import Gt

import umform as uf
from umform.errors import InvalidValue


@dataclass(frozen=True)
class Ludwik:
    """y = first + strength e^exponent."""

    first: Annotated[float, Gt(0.0)]
    """Initial yield stress."""
    strength: float
    """K."""
    exponent: float = 0.3
    """n."""

    def __post_init__(self):
        if self.strength < 0.0:
            raise InvalidValue("K must not be negative", where="strength", value=self.strength, remedy="450")

    def curve(self):
        eqps = np.linspace(0.0, 1.0, 400) ** 3
        return uf.Table(eqps, self.first + self.strength * eqps**self.exponent).curve()


@dataclass(frozen=True)
class Softer(uf.materials.Elastic):
    """SVK with half of its moduli."""

    thickness_points = None

    def law(self):
        return uf.SVK(kappa=0.5 * self.kappa, mu=0.5 * self.mu).law()


def curve():
    pass
'''
CURVE = 'law = "J2"\nE = 210e3\nnu = 0.3\nhardening = { curve = "own_laws:Ludwik", first = 160.0, strength = 450.0 }'


@pytest.fixture
def deck(tmp_path, strip, monkeypatch):
    """A function that writes a deck with a material beside the module of laws."""
    (tmp_path / "own_laws.py").write_text(LAWS, encoding="utf-8")
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "own_laws", raising=False)

    def write(material):
        old = 'law = "SVK"\nE = 210e3\nnu = 0.3'
        assert old in strip
        path = tmp_path / "deck.toml"
        path.write_text(strip.replace(old, material), encoding="utf-8")
        return path

    yield write
    sys.modules.pop("own_laws", None)


def test_without_trust_no_code_runs(deck):
    with pytest.raises(DeckError) as refusal:
        load(deck(CURVE))
    (error,) = refusal.value.errors
    assert "not trusted" in error.what and "--trust" in error.remedy and "load(path, trust=True)" in error.remedy
    assert error.where.endswith("material.hardening.curve") and error.value == "own_laws:Ludwik"
    assert "own_laws" not in sys.modules


def test_another_module_of_the_name_is_not_taken(deck, tmp_path):
    path = deck(CURVE)
    assert load(path, trust=True).contents.material.law.hardening.exponent == 0.3
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "own_laws.py").write_text(LAWS.replace("= 0.3", "= 0.2"), encoding="utf-8")
    other = path.rename(tmp_path / "other" / "deck.toml")
    with pytest.raises(DeckError, match=r"another module of this name(.*\n)*.*was found before .*other.own_laws.py"):
        load(other, trust=True)


RAMP = '''
from dataclasses import dataclass

import umform as uf
from umform.surfaces import ToolSpec


@dataclass(frozen=True)
class Ramp(ToolSpec):
    """Half-space under a plane that rises along x."""

    rise: float
    """Rise per length."""

    def kernel(self):
        return uf.Plane(normal=(-self.rise, 0.0, 1.0)).kernel()
'''


def test_a_tool_of_the_user(deck, tmp_path):
    (tmp_path / "own_laws.py").write_text(RAMP, encoding="utf-8")
    path = deck('law = "SVK"\nE = 210e3\nnu = 0.3')
    text = path.read_text() + '[tools.ramp]\nshape = "own_laws:Ramp"\nrise = 0.75\ntranslation = [0, 0, -2]\n'
    path.write_text(text)
    with pytest.raises(DeckError, match="not trusted"):
        load(path)
    assert load(path, trust=True).build().tools["ramp"].gap([(0.0, 0.0, 0.0)])[0] == pytest.approx(1.6)


def test_a_curve_of_the_user(deck):
    law = load(deck(CURVE), trust=True).build().model.bodies.only.material
    own = sys.modules["own_laws"].Ludwik(160.0, 450.0)
    assert law == uf.J2(210e3, 0.3, hardening=own)
    assert law_keys(law)["hardening"] == {"curve": "own_laws:Ludwik", "first": 160.0, "strength": 450.0}


@pytest.mark.parametrize("method", ["curve", "function", "factor"])
def test_what_a_class_of_the_user_gives_the_kernels_is_checked(method):
    own = type("Own", (), {method: lambda self: uf.Perfect(160.0), "directional": False})()
    field = {"curve": "hardening", "function": "yield_function", "factor": "rate"}[method]
    with pytest.raises(uf.UmformError, match="must return what the kernels take") as refused:
        uf.Metal(210e3, 0.3, **{"hardening": uf.Perfect(160.0), field: own})
    assert refused.value.where == field and "return uf." in refused.value.remedy


def test_a_law_of_the_user(deck):
    material = 'law = "own_laws:Softer"\nE = 210e3\nnu = 0.3\nrolling = "x"'
    model = load(deck(material), trust=True).build().model
    assert pytest.approx(210e3) == model.bodies.only.material.E and model.bodies[0].rolling is not None
    assert law_keys(model.bodies.only.material) == {"law": "own_laws:Softer", "E": 210e3, "nu": 0.3}


@pytest.mark.parametrize(
    ("old", "new", "where", "text"),
    [
        ("first = 160.0", "first = -1.0", "material.hardening.first", "greater than 0"),
        ("strength = 450.0", "strength = -1.0", "material.hardening.strength", "K must not be negative"),
        ("strength = 450.0", "stringth = 450.0", "material.hardening.stringth", "did you mean strength?"),
        ("first = 160.0, ", "", "material.hardening", "Initial yield stress"),
        ("own_laws:Ludwik", "own_laws:Swift", "material.hardening.curve", "cannot be imported"),
        ("own_laws:Ludwik", "no_laws:Swift", "material.hardening.curve", "No module named"),
        ("own_laws:Ludwik", "own_laws:curve", "material.hardening.curve", "must be a dataclass"),
    ],
)
def test_errors_have_their_place(deck, old, new, where, text):
    with pytest.raises(DeckError) as refusal:
        load(deck(CURVE.replace(old, new)), trust=True)
    assert where in str(refusal.value) and text in str(refusal.value)


def test_commands_ask_for_trust(deck):
    path = str(deck(CURVE))
    refused, checked = (CliRunner().invoke(cli.app, ["check", path, *more]) for more in ([], ["--trust"]))
    assert refused.exit_code == 1 and "not trusted" in refused.output
    assert checked.exit_code == 0, checked.output


def test_a_text_is_trusted_by_its_reader(deck):
    text, folder = deck(CURVE).read_text(encoding="utf-8"), deck(CURVE).parent
    assert Problem.read(text, folder=folder, trust=True).source.trust


@pytest.mark.parametrize(
    ("wrong", "said"), [("1 / 0, ", "cause:  ZeroDivisionError"), ("[].pop(), ", "in code of yours: IndexError")]
)
def test_an_error_in_code_of_the_user_names_its_line(deck, tmp_path, wrong, said):
    path = deck('law = "own_laws:Softer"\nE = 210e3\nnu = 0.3\nrolling = "x"')
    (tmp_path / "own_laws.py").write_text(LAWS.replace("return uf.SVK(", f"return uf.SVK({wrong}"), encoding="utf-8")
    failed = CliRunner().invoke(cli.app, ["check", "--trust", str(path)])
    line = next(number for number, text in enumerate(LAWS.splitlines(), start=1) if "return uf.SVK(" in text)
    assert failed.exit_code == 1 and said in failed.stderr
    assert f"{tmp_path / 'own_laws.py'}, line {line}" in failed.stderr and "correct it there" in failed.stderr
