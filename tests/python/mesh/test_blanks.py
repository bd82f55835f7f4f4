"""Discs and rings: area, circle, symmetry, no degenerate cells, sets, layers, and bad input."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter

import umform as uf
from umform.errors import InvalidValue, WrongCellType
from umform.mesh import disc, ring
from umform.mesh.quality import jacobians
from umform.problem.mesh import MeshPart
from umform.problem.tagged import deck_type

PARTS = {"whole": 1.0, "half": 0.5, "quarter": 0.25}


def volume(mesh):
    """Sum of the volumes of the cells, from their mean determinants: exact for vertical prisms of four corners."""
    return 8.0 * float(jacobians(mesh.points, mesh.connectivity).mean(axis=1).sum())


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("cells", [(1, 1), (3, 2), (8, 5)])
def test_cells_are_far_from_degenerate(part, cell, cells):
    for mesh in (disc(50.0, 1.0, cells, part=part, cell=cell), ring(20.0, 50.0, 1.0, cells, part=part, cell=cell)):
        J = jacobians(mesh.points, mesh.connectivity)
        if cells[0] > 1:
            assert (J.min(axis=1) > 0.35 * J.max(axis=1)).all()
        assert J.min() > 0.0


@pytest.mark.parametrize("part", PARTS)
def test_they_fill_the_circle(part):
    """The rim lies on the circle; the area of the polygon comes near with the square of the cells."""
    lacks = []
    for count in (4, 8):
        mesh = disc(50.0, 2.0, (count, count), part=part)
        rim = mesh.points[mesh.nodes("rim")]
        np.testing.assert_allclose(np.hypot(rim[:, 0], rim[:, 1]), 50.0, rtol=1e-12)
        lacks.append(math.pi * 50.0**2 * 2.0 * PARTS[part] - volume(mesh))
    assert 0.0 < lacks[1] < 0.3 * lacks[0]


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_parts_are_parts_of_the_whole(cell):
    whole = {tuple(x) for x in np.round(disc(10.0, 1.0, (3, 2), cell=cell).points, 9) + 0.0}
    for part in ("half", "quarter"):
        mesh = disc(10.0, 1.0, (3, 2), cell=cell, part=part)
        assert {tuple(x) for x in np.round(mesh.points, 9) + 0.0} <= whole
        assert (mesh.points[mesh.nodes("x0"), 0] == 0.0).all() and (mesh.points[:, 0] > -1e-12).all()
        assert len(mesh.nodes("x0")) > 4
    assert (mesh.points[mesh.nodes("y0"), 1] == 0.0).all() and (mesh.points[:, 1] > -1e-12).all()


def test_sets_and_layers():
    mesh = ring(5.0, 10.0, 1.0, (4, 3), layers=2, part="quarter", grading=2.0)
    assert len(mesh.connectivity) == 4 * 3 * 2
    assert len(mesh.faces["lower"]) == len(mesh.faces["upper"]) == 12
    assert len(mesh.nodes("rim")) == 3 * 5 and len(mesh.nodes("hole_lower")) == 5
    assert (mesh.points[mesh.nodes("rim_upper"), 2] == 0.5).all()
    radii = np.unique(np.round(np.hypot(*mesh.points[:, :2].T), 9))
    assert (radii[3] - radii[2]) / (radii[1] - radii[0]) == pytest.approx(2.0)
    assert len(disc(5.0, 1.0, (2, 2)).nodes("centre")) == 2


def test_a_quarter_and_the_whole_bend_alike():
    """A clamped disc under pressure: the same deflection of the centre."""
    deflections = []
    for part in ("whole", "quarter"):
        mesh = disc(10.0, 0.5, (4, 3), part=part)
        model = uf.Model(mesh, material=uf.SVK(E=1000.0, nu=0.3))
        model.fix("rim")
        for name in ("x0", "y0") if part == "quarter" else ():
            model.symmetry(name, normal=name[0])
        pressure = model.pressure("lower")
        uf.solve(model, uf.Move(pressure, 1e-3, steps=1), progress=False)
        deflections.append(model.u.reshape(-1, 3)[mesh.nodes("centre"), 2].mean())
    assert deflections[0] == pytest.approx(deflections[1], rel=1e-6)
    plate = 1e-3 * 10.0**4 / (64 * 1000.0 * 0.5**3 / (12 * (1 - 0.09)))
    assert deflections[0] == pytest.approx(plate, rel=0.03)


@pytest.mark.parametrize(
    "wrong", [{"part": "third"}, {"cells": (3,)}, {"cells": (0, 2)}, {"radius": -1.0}, {"layers": 0}]
)
def test_blanks_that_make_no_sense_are_refused(wrong):
    with pytest.raises(InvalidValue):
        disc(**{"radius": 5.0, "thickness": 1.0, "cells": (2, 2)} | wrong)


def test_rings_and_cells_that_make_no_sense_are_refused():
    with pytest.raises(InvalidValue):
        ring(5.0, 4.0, 1.0, (2, 2))
    with pytest.raises(WrongCellType):
        disc(5.0, 1.0, (2, 2), cell="wedge")


@pytest.mark.parametrize(
    ("table", "sets"),
    [
        (
            {"generator": "disc", "radius": 5.0, "thickness": 1.0, "cells": [2, 3], "part": "half"},
            {"rim", "centre", "x0"},
        ),
        ({"generator": "ring", "inner": 2.0, "outer": 5.0, "thickness": 1.0, "cells": [2, 3]}, {"rim", "hole"}),
    ],
)
def test_decks_make_them(table, sets):
    part = TypeAdapter(deck_type(MeshPart)).validate_python(table)
    mesh = part.build("hex18", Path())
    assert sets <= set(mesh.sets) and mesh.cell == "hex18"
