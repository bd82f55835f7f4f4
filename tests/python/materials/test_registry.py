"""A new hardening curve is one class in one file: Python, decks, schema, commands and docs know it."""

import importlib.util
from pathlib import Path

import pytest

import umform
from umform.materials import Hardening, RateFactor, YieldFunction
from umform.materials.known import known

ROOT = Path(__file__).parents[3]
_SPEC = importlib.util.spec_from_file_location("material_tables", ROOT / "tools" / "material_tables.py")
tables = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(tables)

LUDWIK = '''
"""A curve that somebody added."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from umform import _core
from umform.materials.hardening import Hardening, Table, YieldStress
from umform.spec import check_fields
from umform.spec.types import NotNegative


@dataclass(frozen=True)
class Ludwik(Hardening):
    """Ludwik hardening: y = first + strength e^exponent."""

    first: YieldStress
    """Initial yield stress."""
    strength: NotNegative
    """K, a stress."""
    exponent: NotNegative = 0.3
    """n."""

    def __post_init__(self) -> None:
        check_fields(self)

    def curve(self) -> _core.Hardening:
        eqps = np.linspace(0.0, 1.0, 400) ** 3
        return Table(eqps, self.first + self.strength * eqps**self.exponent).curve()
'''
SEEN = """
import json, sys
from importlib.util import module_from_spec, spec_from_file_location

from typer.testing import CliRunner

import umform as uf
from umform.cli import app
from umform.problem import Problem
from umform.problem.contents import json_schema
from umform.problem.keys import law_keys
from umform.sheet_metals import uniaxial

assert uf.Ludwik is uf.materials.Ludwik and "Ludwik" in dir(uf)
names = {}
exec("from umform import *", names)
assert names["Ludwik"] is uf.Ludwik
law = uf.J2(210e3, 0.3, hardening=uf.Ludwik(160.0, 450.0))
assert law_keys(law)["hardening"] == {"curve": "Ludwik", "first": 160.0, "strength": 450.0}

text = open(sys.argv[1]).read()
assert Problem.read(text).build().model.bodies.only.material == law
part = json.loads(json_schema())["$defs"]["Ludwik"]
assert part["properties"]["curve"]["const"] == "Ludwik"
assert part["properties"]["strength"]["description"] == "K, a stress."

done = CliRunner().invoke(app, ["bend", "--stroke", "1", "--curve", "Ludwik,160,450,0.2", "--print-deck"])
assert 'hardening = { curve = "Ludwik", first = 160.0, strength = 450.0, exponent = 0.2 }' in done.stdout, done.output

spec = spec_from_file_location("material_tables", sys.argv[2])
tables = module_from_spec(spec)
spec.loader.exec_module(tables)
assert "| `Ludwik(first, strength, exponent=0.3)` | Ludwik hardening: y = first + strength e^exponent. |" in (
    tables.table("hardening curve")
)
"""


def test_a_class_in_a_file_is_all(package_copy, tmp_path, strip):
    package_copy.write("materials/ludwik.py", LUDWIK)
    deck = tmp_path / "deck.toml"
    curve = 'hardening = { curve = "Ludwik", first = 160.0, strength = 450.0 }'
    deck.write_text(strip.replace('"SVK"', '"J2"').replace("nu = 0.3", f"nu = 0.3\n{curve}"), encoding="utf-8")
    package_copy.run(SEEN, deck, ROOT / "tools" / "material_tables.py")


@pytest.mark.parametrize("interface", [Hardening, YieldFunction, RateFactor])
def test_each_class_of_a_kind_is_public(interface):
    assert known(interface)
    for name, kind in known(interface).items():
        assert getattr(umform, name) is kind


def test_the_tables_of_the_docs_are_those_of_the_classes():
    page = tables.PAGE.read_text(encoding="utf-8")
    assert page.count("<!-- /") == len(tables.KINDS)
    assert tables.written(page) == page, "python tools/material_tables.py"
