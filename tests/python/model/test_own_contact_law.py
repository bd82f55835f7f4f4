"""Contact laws of a user: exact tangents at points and over cells, the same as the penalty, energies, refusals."""

from __future__ import annotations

import ctypes
import runpy
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import umform as uf
from umform import _core
from umform.errors import InvalidValue, NotFinite
from umform.results.penetration import penetrations

#: The plate and the tools of the tests of cells.
cells_of = SimpleNamespace(**runpy.run_path(str(Path(__file__).with_name("test_contact_cells.py"))))
PENALTY = 3e3
STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(565.3, 0.0071, 0.259))
RULES = [{}, {"cells": 3}, {"points": "nodes"}, {"friction": 0.1}, {"friction": 0.1, "cells": 2}]


def linear(gap):
    return -PENALTY * gap, np.full_like(gap, -PENALTY)


def layer(gap):
    """A layer that presses by the power 3/2 of what it is squeezed."""
    squeezed = 0.04 - gap
    return 900.0 * squeezed**1.5, -1350.0 * np.sqrt(squeezed)


def thin(gap):
    squeezed = 0.002 - gap
    return 900.0 * squeezed**1.5, -1350.0 * np.sqrt(squeezed)


LAYER, THIN = uf.ContactLaw(layer, reach=0.04, name="layer"), uf.ContactLaw(thin, reach=0.002, name="thin layer")


def bend(law=None, steps=16, **options):
    strip = uf.mesh.strip(length=30, width=2, thickness=1, cells=(12, 1))
    model = uf.Model(strip, material=STEEL)
    model.fix(lambda x, y, z: x > -1, "y")
    model.symmetry("x0", normal="x")
    punch = model.tool("punch", uf.Cylinder((0, 0, 5.6), "y", 5))
    die = model.tool("die", uf.Cylinder((12, 0, -5.6), "y", 5))
    for faces, tool in (("upper", punch), ("lower", die)):
        model.contact(faces, tool, name=f"on {tool.name}", law=law, **options)
    stroke = model.drive(punch, "z", name="stroke")
    return model, uf.solve(model, uf.Move(stroke, to=-4.0, steps=steps), progress=False)


# The tangent ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("friction", [None, 0.2])
@pytest.mark.parametrize("rule", ["points", "cells"])
@pytest.mark.parametrize("tool", ["cylinder", "sphere", "ellipsoid"])
def test_tangent(rule, tool, friction, rng):
    mesh = cells_of.plate()
    if friction is None:
        law = _core.own_law(100.0, THIN.kernel())
    else:
        law = _core.own_coulomb_law(100.0, 1.0, 0.02, uf.Friction(friction).kernel(), THIN.kernel())
    surface = cells_of.TOOLS[tool]
    if rule == "cells":
        block = cells_of.block_over(mesh, surface, 3, law)
    else:
        block = _core.contact_block(mesh.facets("lower"), mesh.points, (3, 3), False, surface.kernel(), law)
    start, end = cells_of.waved(mesh, rng), cells_of.waved(mesh, rng)
    block.locate(start)
    block.begin()
    cells_of.respond(block, start)
    block.commit()
    assert block.symmetric == (rule == "points" and friction is None)
    block.locate(end)
    found = block.found()
    assert (found.active > 0).sum() > 0
    assert ((found.share < 1.0).any() if rule == "cells" else (found.active == 0).any()) or tool == "ellipsoid"
    cells_of.assert_exact_tangent(block, mesh, end, rng, 1e-7)


def test_cells_integrate_polynomials_exactly():
    """A cubic pressure over a unit cell that the reach cuts: the integral of (s - x)^3 from 0 to s, and its energy."""
    reach, slope = 0.04, 0.2
    cubic = uf.ContactLaw(lambda gap: (5e4 * (reach - gap) ** 3, -15e4 * (reach - gap) ** 2), reach=reach)
    mesh = uf.mesh.strip(1.0, 1.0, 1.0, (1, 1))
    mesh.points[:] += [0.0, 0.5, 0.5]
    tilted = uf.UserSurface(
        lambda x: (slope * (x[:, 0] - 0.7), np.tile([slope, 0.0, 0.0], (len(x), 1)), np.zeros((len(x), 3, 3)))
    )
    block = _core.contact_cells(
        mesh.facets("lower"), mesh.points, 1, tilted.kernel(), _core.own_law(100.0, cubic.kernel())
    )
    cells_of.respond(block, np.zeros(mesh.points.size))
    block.commit()
    end = 0.7 + reach / slope
    assert end < 1.0
    found = block.found()
    assert found.share[0] == pytest.approx(end, rel=1e-12)
    assert found.pressure[0] == pytest.approx(5e4 * slope**3 * end**4 / 4.0, rel=1e-12)
    assert found.contact_work == pytest.approx(5e4 * slope**4 * end**5 / 20.0, rel=1e-12)


def test_what_check_contact_law_sees():
    gaps = np.linspace(-0.05, 0.03, 9)
    good = uf.check_contact_law(LAYER, gaps)
    assert good < 1e-7
    assert (good.jump, good.rises) == (0.0, 0.0)
    wrong = uf.ContactLaw(lambda gap: (layer(gap)[0], 0.9 * layer(gap)[1]), reach=0.04)
    assert uf.check_contact_law(wrong, gaps) == pytest.approx(0.1, abs=1e-3)
    stands = uf.ContactLaw(lambda gap: (10.0 - 100.0 * gap, np.full_like(gap, -100.0)))
    assert uf.check_contact_law(stands, [-0.1, -0.05]).jump == pytest.approx(0.5)
    softens = uf.ContactLaw(lambda gap: (-gap * (1.0 + 10.0 * gap), -1.0 - 20.0 * gap))
    assert uf.check_contact_law(softens, [-0.09, -0.01]).rises > 0.9
    assert str(good).startswith("deviation ")
    with pytest.raises(InvalidValue, match=r"ContactLaw\(function"):
        uf.check_contact_law(lambda gap: (-gap, -1.0 + 0.0 * gap), [-0.1])
    with pytest.raises(InvalidValue, match="within its reach"):
        uf.check_contact_law(LAYER, [0.1])


# Whole bends ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("options", RULES, ids=str)
def test_a_linear_law_is_the_penalty(options):
    _, by_penalty = bend(penalty=PENALTY, **options)
    model, by_law = bend(uf.ContactLaw(linear), **options)
    np.testing.assert_allclose(by_law["stroke_force"], by_penalty["stroke_force"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(by_law["contact_energy"], by_penalty["contact_energy"], rtol=1e-10, atol=1e-12)
    assert list(by_law["iterations"]) == list(by_penalty["iterations"])
    touch, expected = (result.balance().works["contact beyond the mean"] for result in (by_law, by_penalty))
    np.testing.assert_allclose(touch, expected, rtol=0, atol=1e-9)
    assert "cells" in options or np.abs(expected).max() > 1e-4
    np.testing.assert_allclose(by_law["on die_penalty"], PENALTY, rtol=1e-14)
    reached = penetrations(model, by_law)["on die"]
    assert reached.allowed is None
    assert reached.reached > 0.0
    assert reached.force_error == 0.0


@pytest.mark.parametrize("options", RULES[:4], ids=str)
def test_energies_balance(options):
    """The energy of the law is the integral of its pressure: the drift falls with the increments."""
    coarse, fine = (abs(bend(LAYER, steps, **options)[1].balance().drift).max() for steps in (16, 48))
    assert fine < 2e-3
    assert fine < 0.4 * coarse


def test_the_measure_of_its_stiffness():
    """The pressure at 1/200 of the thickness, or at the allowed penetration, over the way to it from the reach."""
    for options, depth in (({}, 0.005), ({"penetration": 0.02}, 0.02)):
        model, _ = bend(LAYER, 1, **options)
        assert model.contacts[0].penalty == pytest.approx(900.0 * (0.04 + depth) ** 0.5)
        assert model.contacts[0].largest_penalty == 0.0


def test_energy_of_an_elastic_sheet_by_hand():
    """A block under a plane: the energy is that of the layer at one gap, and the work of the press."""
    block = uf.mesh.strip(length=2, width=2, thickness=1, cells=(1, 1))
    model = uf.Model(block, material=uf.SVK(E=1e7, nu=0.0))
    model.fix("lower", "z")
    model.symmetry("x0", "x"), model.symmetry("y0", "y")
    plate = model.tool("plate", uf.Plane((0, 0, 0.55), (0, 0, -1)))
    contact = model.contact("upper", plate, law=LAYER, name="pad")
    way = model.drive(plate, "z", name="way")
    result = uf.solve(model, uf.Move(way, to=-0.04, steps=10), progress=False)
    squeezed = 0.04 - contact.found.held.gap[0]
    assert squeezed == pytest.approx(0.03, rel=1e-3)
    assert abs(result["way_force"][-1]) == pytest.approx(4.0 * 900.0 * squeezed**1.5, rel=1e-9)
    assert result["contact_energy"][-1] == pytest.approx(4.0 * 360.0 * squeezed**2.5, rel=1e-5)
    assert not result.warnings


def test_a_stiff_law_converges_by_a_softer_one(monkeypatch):
    """Continuation in the penalty scales the pressures of the law."""
    contact = bend(LAYER, 1)[0].contacts[0]
    whole, energy = contact.block.law, contact.found.energy()
    assert whole.penalty == contact.penalty
    contact.use_penalty(0.1 * contact.penalty)
    at = contact._found(0.0, contact._mesh_points.ravel() * 0.0, contact.pose)
    assert contact.block.law.penalty == pytest.approx(0.1 * contact.initial_penalty)
    contact.use_penalty(contact.initial_penalty)
    before, change = contact.found, np.zeros(contact._mesh_points.size)
    contact.stiffen(before, 10.0 * contact.penalty, change)
    total = change.reshape(-1, 3).sum(axis=0)
    np.testing.assert_allclose(total, 0.9 * before.resultant()[0], rtol=1e-9, atol=1e-9)
    assert energy > 0.0
    assert at.held is not None


# Compiled ---------------------------------------------------------------------------------------------------

SOURCE = """
#include <math.h>
int layer(int n, const double* gap, const double* properties, double* pressure, double* slope) {
    for (int i = 0; i < n; ++i) {
        const double d = properties[1] - gap[i];
        pressure[i] = properties[0] * pow(d, 1.5), slope[i] = -1.5 * properties[0] * sqrt(d);
    }
    return 0;
}
int beyond(int n, const double* gap, const double* properties, double* pressure, double* slope) {
    for (int i = 0; i <= n; ++i) pressure[i] = slope[i] = 0.0;
    return 0;
}
int refuses(int n, const double* gap, const double* properties, double* pressure, double* slope) { return 3; }
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path_factory.mktemp("laws")
    (folder / "law.c").write_text(SOURCE)
    out = folder / "law.so"
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-o", out, folder / "law.c", "-lm"], check=True)
    return out


@pytest.mark.parametrize("options", [{}, {"cells": 3, "friction": 0.1}], ids=str)
def test_compiled_law(library, options):
    law = uf.CompiledContactLaw("layer", library, properties=(900.0, 0.04), reach=0.04)
    assert uf.check_contact_law(law, np.linspace(-0.05, 0.03, 9)) < 1e-7
    _, compiled = bend(law, 8, **options)
    _, python = bend(LAYER, 8, **options)
    np.testing.assert_allclose(compiled["stroke_force"], python["stroke_force"], rtol=0, atol=1e-9)
    assert law.content
    of_ctypes = ctypes.CDLL(str(library)).layer
    assert uf.CompiledContactLaw(of_ctypes, properties=(900.0, 0.04), reach=0.04).kernel().reach == 0.04


def test_a_compiled_law_that_writes_too_far_or_has_no_answer(library):
    for function, words in (("beyond", "written beyond its pressures"), ("refuses", "has no answer")):
        with pytest.raises(NotFinite, match=words):
            uf.CompiledContactLaw(function, library).kernel().pressures(np.array([-0.1, -0.2]))
    with pytest.raises(InvalidValue, match="needs a C function") as refused:
        uf.CompiledContactLaw(lambda gap: gap)
    assert "ContactLaw takes Python" in str(refused.value)


# Refusals ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"penalty": 100.0}, "penalty or a contact law"),
        ({"augmented": True}, "no multipliers"),
        ({"points": "auto"}, "number of contact points"),
        ({"cells": "auto"}, "number of contact points"),
        ({"law": uf.ContactLaw(lambda gap: (gap, np.ones_like(gap)))}, "finite pressures that are not negative"),
        ({"law": uf.ContactLaw(lambda gap: (0 * gap, 0 * gap))}, "must press where the sheet is in the tool"),
        ({"law": uf.ContactLaw(lambda gap: -gap)}, "must return two arrays"),
        ({"law": uf.ContactLaw(lambda gap: (1.0, -gap))}, "must have the shape"),
        ({"law": 100.0}, "law"),
    ],
    ids=lambda value: str(value) if isinstance(value, str) else "",
)
def test_refused(options, words):
    with pytest.raises((InvalidValue, NotFinite), match=words):
        bend(**{"law": LAYER, **options})


def test_errors_name_the_pair_and_the_signature():
    def broken(gap):
        if (gap > -0.004).any():
            raise ZeroDivisionError("own mistake")
        return linear(gap)

    with pytest.raises(ZeroDivisionError) as raised:
        bend(uf.ContactLaw(broken, name="pad"))
    note = "".join(raised.value.__notes__)
    assert "contact on punch, pad" in note
    assert "law(gap) -> pressure, slope" in note

    def sticky(pressure, slip, place):
        raise KeyError("own mistake")

    with pytest.raises(KeyError) as raised:
        bend(penalty=PENALTY, friction=lambda *given: 0.1 * given[0] if given[0] == 1 else sticky(*given))
    assert "friction(pressure, slip, place)" in "".join(raised.value.__notes__)

    model, _ = bend(LAYER, 1)
    with pytest.raises(InvalidValue, match="no penalty to be set"):
        model.contacts[0].penalty = 10.0


def test_a_penetration_that_is_allowed_is_checked():
    model, result = bend(uf.ContactLaw(linear), 4, penetration=1e-4)
    assert any("exceeds the 0.0001 allowed; a stiffer contact law" in text for text in result.warnings)
    assert not penetrations(model, result)["on punch"].kept
