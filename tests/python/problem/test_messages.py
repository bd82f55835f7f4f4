import pickle

import pytest

from umform.errors import FileProblem
from umform.problem import DeckError, Problem, load

STRIP = 'generator = "strip"\nlength = 10.0\nwidth = 2.0\nthickness = 1.0\ncells = [4, 2]'
GRID = 'generator = "grid"\nx = [0, 2, 1]\ny = [0, 1]\nz = [0, 1]'
RING = 'generator = "ring"\ninner = 5\nouter = 4\nthickness = 1\ncells = [4, 4]'
MOVE = 'kind = "move"\nto = { pull = 0.1 }\nincrements = 2'


def limit(points):
    """A forming limit instead of the last line."""
    return MOVE, f"{MOVE}\n[output]\nforming_limit = {points}", 24, "output.forming_limit"


def motion(times):
    """A motion of one row instead of the last line."""
    tool = '[tools.die]\nshape = "Plane"\n[contacts.die]\ntool = "die"\nfaces = "lower"'
    return MOVE, f"{MOVE}\n{tool}\nmotion = {{ time = {times}, translation = [[0, 0, 0]] }}", 28


#: What is written in the strip instead, and what is said: line, key, value, a word of the cause and of the remedy.
SLIPS = {
    "unknown key": ("length = 10.0", "lenght = 10.0", 4, "mesh.lenght", "10.0", "length", "known keys"),
    "missing key": ("length = 10.0", "", 2, "mesh", None, "", "length"),
    "unknown table": ("[[supports]]", "[[suports]]", 12, "suports", None, "supports", "known keys"),
    "unknown generator": ('"strip"', '"stripe"', 3, "mesh.generator", "stripe", "strip", "plate"),
    "unknown law": ('"SVK"', '"SVC"', 9, "material.law", "SVC", "SVK", "J2"),
    "misspelt law": ("law =", "lav =", 8, "material", None, "lav for law", "add law"),
    "unknown kind": ('"fix"', '"fixx"', 13, "supports[0].kind", "fixx", "fix", "hinge"),
    "unknown word": ('direction = "x"', 'direction = "X"', 18, "controls.pull.direction", "X", "x", "x, y, z"),
    "word for a number": ("E = 210e3", 'E = "210e3"', 10, "material.E", "210e3", "word", "without quotes"),
    "truth for a number": ("nu = 0.3", "nu = true", 11, "material.nu", "true", "truth", "without quotes"),
    "out of bounds": ("nu = 0.3", "nu = 0.5", 11, "material.nu", "0.5", "typing error", "bound"),
    "too many digits": ("E = 210e3", f"E = {'9' * 400}", 10, "material.E", None, "hundreds of digits", "a number"),
    "number for an array": ("[4, 2]", "4", 7, "mesh.cells", "4", "one value", "write an array"),
    "empty word": (
        "[material]",
        '[output]\nfolder = ""\n[material]',
        9,
        "output.folder",
        "",
        "quotes",
        "leave the key out",
    ),
    "not finite": ("nu = 0.3", "nu = nan", 11, "material.nu", "nan", "nan", "finite"),
    "entry of an array": ("[4, 2]", "[4,\n 2.5]", 8, "mesh.cells[1]", "2.5", "fraction", "whole number"),
    "array too short": ("[4, 2]", "[4]", 7, "mesh.cells", "[4]", "left out", "counted from 0"),
    "inline table": ("{ pull = 0.1 }", '{ pull = "a" }', 21, "steps[0].to.pull", "a", "word", "number"),
    "dotted key": ("nu = 0.3", "nu = 0.3\nhardening.curve = 3", 12, "material.hardening", None, "", "known keys"),
    "unknown control": ("{ pull", "{ pul", 21, "steps[0].to.pul", "pul", "pull", "controls: pull"),
    "unknown set": ('"x0"', '"x9"', 14, "supports[0].nodes", "x9", "typing error", "x0"),
    "unknown element": (
        "[material]",
        '[element]\nname = "ANS3"\n[material]',
        9,
        "element.name",
        "ANS3",
        "",
        "ANS3DEAS",
    ),
    "too many cells": ("[4, 2]", "[90000, 9000]", 7, "mesh.cells", None, "sizes", "fewer cells"),
    "negative grading": ("[4, 2]", "[4, 2]\ngrading = [1.0, -2.0]", 8, "mesh.grading", "(1.0, -2.0)", "sign", "size"),
    "tight roll": ("[4, 2]", "[4, 2]\nrolled = 0.2", 8, "mesh.rolled", "0.2", "curvature", "more than 0.5"),
    "roll over itself": ("[4, 2]", "[4, 2]\nrolled = 1.0", 4, "mesh.length", "10.0", "overlap", "less than 6.283"),
    "lines out of order": (STRIP, GRID, 4, "mesh.x", "[0.0, 2.0, 1.0]", "out of order", "sort them"),
    "radii exchanged": (STRIP, RING, 5, "mesh.outer", "4.0", "exchanged", "more than 5"),
    "corners exchanged": (
        '"x0"',
        "{ min = [1, 0, 0], max = [0, 0, 0] }",
        14,
        "supports[0].nodes",
        None,
        "",
        "min <= max",
    ),
    "increments and pace": (
        "increments = 2",
        "increments = 2\npace = {}",
        22,
        "steps[0].increments",
        "2",
        "",
        "one of",
    ),
    "increments and increment": (
        MOVE,
        'kind = "release"\ncontrol = "pull"\nincrements = 2\nincrement = 0.1',
        22,
        "steps[0].increments",
        "2",
        "each sets the size",
        "one of them",
    ),
    "nothing freed": (MOVE, 'kind = "free"', 19, "steps[0]", None, "neither is given", "contacts = ["),
    "limit of one point": (*limit("[[0.0, 0.3]]"), "[(0.0, 0.3)]", "major strains first", "Keeler-Brazier"),
    "limit in per cent": (*limit("[[-20, 50], [20, 40]]"), None, "larger than 3", "ln(1.3)"),
    "times out of order": (*motion("[0, 0]"), "motion.time", "[0.0, 0.0]", "out of order", "sort the rows"),
    "row of a motion left out": (*motion("[0, 1]"), "motion.translation", None, "left out", "for each time"),
    "constants of two kinds": ("nu = 0.3", "mu = 0.3", 8, "material", None, "", ""),
    "no way": ('"x1"', "{ neerest = [0, 0, 0] }", 17, "controls.pull.nodes", None, "", ""),
    "bad name": ("{ pull", '{ "a b" = 1, pull', 21, "steps[0].to", "a b", "", ""),
    "value twice": (
        "nu = 0.3",
        "nu = 0.3\nnu = 0.2",
        12,
        "",
        "nu = 0.2",
        "material.nu is given twice: it stands on line 11",
        "take one",
    ),
    "table twice": (
        "[[supports]]",
        "[mesh]\n[[supports]]",
        12,
        "",
        "[mesh]",
        "mesh is given twice: it stands on line 2",
        "one header",
    ),
    "key of an inline table twice": (
        "{ pull = 0.1 }",
        "{ pull = 0.1, pull = 0.2 }",
        21,
        "",
        None,
        "stands on line 21",
        "take one",
    ),
    "decimal comma": (
        "thickness = 1.0",
        "thickness = 1,5  # mm",
        6,
        "",
        None,
        "decimal comma",
        "decimal point: thickness = 1.5",
    ),
    "thousands": ("E = 210e3", "E = 210.000,5", 10, "", "E = 210.000,5", "decimal comma", "E = 210000.5"),
    "comma in braces": ("{ pull = 0.1 }", "{ pull = -0,1 }", 21, "", None, "decimal comma", "pull = -0.1"),
    "commas in an array": ("[4, 2]", "[4,0, 2,0]", 7, "mesh.cells", None, "decimal comma", "decimal point"),
    "nothing before the point": ("nu = 0.3", "nu = .3", 11, "", "nu = .3", "one side of the point", "write 0.3"),
    "nothing behind the point": ("length = 10.0", "length = 10.", 4, "", None, "one side of the point", "write 10.0"),
    "umlaut in a table": ("[material]", "[wärme]", 8, "", "[wärme]", "cannot have: wärme", "waerme"),
    "umlaut in a name": (
        "[controls.pull]",
        "[controls.größe]",
        15,
        "",
        None,
        "cannot have: controls.größe",
        "controls.groesse",
    ),
    "umlaut in a key": ("length = 10.0", "länge = 10.0", 4, "", "länge = 10.0", "cannot have: länge", "laenge"),
    "accent in a key": ("length = 10.0", "épaisseur = 10.0", 4, "", None, "cannot have: épaisseur", "epaisseur"),
    "no quotes": ('"strip"', "strip", 3, "", "generator = strip", "value", "words stand in quotes"),
    "string without an end": ('"strip"', '"strip', 3, "", 'generator = "strip', "character", "words stand in quotes"),
}


@pytest.mark.parametrize("name", SLIPS)
def test_each_slip_is_told_with_place_value_cause_and_remedy(name, strip, errors):
    old, new, line, key, value, cause, remedy = SLIPS[name]
    assert old in strip
    found = errors(strip.replace(old, new, 1))
    told = next(error for error in found if f"line {line}" in error.where and key in error.where)
    assert told.where.startswith("deck.toml, line ")
    if value is not None:
        assert str(told.value) == value
    assert cause in told.cause
    assert remedy in told.remedy
    assert told.cause
    assert told.remedy


def test_all_slips_are_told_at_once(strip, errors):
    text = strip
    for name in ("unknown key", "unknown law", "unknown kind", "word for a number", "unknown control"):
        old, new, *_ = SLIPS[name]
        text = text.replace(old, new, 1)
    lines = [int(error.where.split("line ")[1].split(",")[0]) for error in errors(text)]
    assert {4, 9, 13, 21} <= set(lines)


def test_all_that_cannot_be_built_is_told_at_once(strip, errors):
    text = strip + '[[supports]]\nkind = "hinge"\nnodes = "x7"\n[tools.die]\nshape = "VDie"\n'
    text += "opening = 10.0\nangle = 90.0\nshoulder_radius = 1.0\ndepth = 5.0\n"
    wheres = [error.where for error in errors(text.replace('nodes = "x0"', 'nodes = "x8"'))]
    assert len(wheres) == 3
    for where, key in zip(wheres, ("tools.die.depth", "supports[0].nodes", "supports[1].nodes"), strict=True):
        assert key in where
    text = text.replace("nu = 0.3", "nu = 0.3\n[element]\nname = 'ANS4'").replace(
        "cells = [4, 2]", "cells = [4, 2]\nlayers = 2"
    )
    assert [error.what for error in errors(text)] == [
        "a flat bottom must lie above the point of the V",
        "unknown element",
    ]


def test_an_error_travels_between_processes(strip, errors):
    with pytest.raises(DeckError) as caught:
        Problem.read(strip.replace("length", "lenght"))
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value)
    assert "deck has" in again.what


def test_files_that_are_no_decks(tmp_path):
    for path in (tmp_path, tmp_path / "missing.toml"):
        with pytest.raises(FileProblem, match="cannot be read"):
            load(path)
    (tmp_path / "image.toml").write_bytes(b"\x89PNG\xff")
    with pytest.raises(FileProblem, match="no text"):
        load(tmp_path / "image.toml")
    (tmp_path / "deep.toml").write_text("a = " + "[" * 20000)
    with pytest.raises(DeckError, match="no TOML"):
        load(tmp_path / "deep.toml")
    (tmp_path / "long.toml").write_text("a = " + "1" * 20000)
    with pytest.raises(DeckError, match="no TOML"):
        load(tmp_path / "long.toml")


def test_changes_of_keys(strip):
    deck = Problem.read(strip, changes={"steps.0.increments": 7, "solution.line_search": True, "mesh.cells.0": 3})
    assert deck.contents.steps[0].increments == 7
    assert deck.contents.solution.line_search
    assert deck.contents.mesh.cells == (3, 2)
    for key in ("steps.4.increments", "steps.0.to.pull.x", "mesh.cells.9"):
        with pytest.raises(DeckError, match="nowhere"):
            Problem.read(strip, changes={key: 1})
