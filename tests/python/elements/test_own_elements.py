"""Elements of the user: the complete order with a plastic law, and modes that the quadrature in use cannot carry."""

from dataclasses import replace

import numpy as np
import pytest

from umform import J2, SVK, Linear, Model, Move, UserLaw, solve
from umform.elements import Element, Mode, Tying, at_order, element
from umform.errors import InvalidValue
from umform.mesh import strip
from umform.model.element_check import check_element

STEEL = J2(E=206e3, nu=0.3, hardening=Linear(200.0, 2000.0))
SHEAR = (Mode("12", 1), Mode("12", 0, 1))
ANS = element("ANS3DEAS")
BILINEAR = tuple(Mode("33", a, b, 1) for b in (0, 1) for a in (0, 1))


def model_of(made, material=STEEL, **options):
    return Model(strip(20.0, 4.0, 1.0, (6, 1)), made, material=material, **options)


def layered(made):
    return replace(made, name="layered", tying=tuple(replace(row, at_layer=True) for row in made.tying))


@pytest.mark.parametrize(
    ("made", "modes"),
    [
        (layered(ANS), 44),
        (replace(ANS, name="more", modes=ANS.modes + SHEAR), 46),
        (Element("own", "hex8", ANS.tying, SHEAR + BILINEAR), 46),
        (Element("own", "hex8", ANS.tying, (*BILINEAR, Mode("33", c=3)), thickness_order=3), 44),
        (replace(ANS, complete=False), 4),
        (Element("none", "hex8", ANS.tying, SHEAR), 2),
    ],
)
def test_own_elements_have_the_complete_order_with_a_plastic_law(made, modes):
    model = model_of(made)
    complete = modes >= 44
    assert model.bodies.only.thickness_points == (5 if made.name == "none" else 12)
    assert model.bodies.only.block.modes == modes
    assert model.bodies.only.element.thickness_order == (11 if complete else made.thickness_order)
    assert model.bodies.only.element.tying == made.tying
    others = {mode for mode in made.modes if mode.polynomials[0].component != "33"}
    assert others <= set(model.bodies.only.element.modes)
    graded = model_of(made, thickness_points=18, thickness_rule="graded")
    assert set(made.modes) <= set(graded.bodies.only.element.modes)
    assert not complete or graded.bodies.only.block.modes == 20 + len(others)
    assert model_of(made, SVK(E=206e3, nu=0.3)).bodies.only.block.modes == len(made.modes)


@pytest.mark.parametrize("name", ["ANS3DEAS", "EAS3DEAS", "MI9K3DEAS", "BEND18"])
def test_the_catalogue_has_the_modes_of_the_order(name):
    assert at_order(element(name), 7).modes == element(name, thickness_order=7).modes
    assert element(name).thickness_order == element(name).options["thickness_order"]


def test_the_complete_order_of_own_modes_spans_that_of_the_catalogue():
    own = at_order(Element("own", "hex18", modes=element("MI9K3DEAS").modes), 4)
    assert own.surface_points == 3
    t, w = np.polynomial.legendre.leggauss(5)
    both = np.hstack([own.mode_values(t, w), element("MI9K3DEAS", thickness_order=4).mode_values(t, w)])
    assert np.linalg.matrix_rank(both) == len(own.modes) == 36


def permanent_set(made):
    model = model_of(made)
    model.fix("x0", "x")
    model.fix("y0", "y")
    model.fix(lambda x, y, z: (x < 1e-6) & (z < 0), "z")
    load = model.traction("x1", (0, 0, -1.0))
    solve(model, [Move(load, to=2.2, steps=3), Move(load, to=0.0, steps=1)], progress=False)
    return model.u.reshape(-1, 3)[model.mesh.nodes("x1"), 2].mean()


def test_a_renamed_element_springs_back_as_that_of_the_catalogue():
    own = Element("own", "hex8", ANS.tying, ANS.modes)
    expected = permanent_set("ANS3DEAS")
    assert abs(expected) > 1e-3
    assert permanent_set(own) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("modes", "words"),
    [
        ((Mode("11", 4) + Mode("11", factor=-0.2),), "mean of an enhanced mode"),  # of the cube, not of the points
        ((Mode("11", 2) + Mode("11", factor=-1 / 3),), "vanishes"),
        ((Mode("33", c=4),), None),
    ],
)
def test_modes_are_checked_under_the_rule_in_use(modes, words):
    def build(**options):
        return model_of(Element("own", "hex8", ANS.tying, modes), SVK(E=1.0, nu=0.3), **options)

    if words is not None:
        with pytest.raises(InvalidValue, match=words):
            build()
    else:
        assert build().bodies.only.thickness_points == 5  # as the order needs
        with pytest.raises(InvalidValue, match="order 4 needs at least 5"):
            build(thickness_points=2)


def test_a_mode_without_mean_at_the_points_is_taken():
    centred = Mode("11", 2, 1) + Mode("11", 0, 1, factor=-1.0)
    nine = Mode("11", 4) + Mode("11", factor=-0.2)  # 3 x 3 points are exact
    assert Element("own", "hex8", modes=(centred,), surface_points=3).thickness_order == 0
    assert Element("own", "hex18", modes=(nine,)).surface_points == 3


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"modes": Mode("11", 1)}, "with the comma"),
        ({"modes": ((Mode("11", 1),),)}, "tuple of Mode"),
        ({"tying": (Tying("13", r=0.0, s=(-1.0, 1.0)),)}, "abscissae of a tying row are tuples"),
        ({"tying": ("13",)}, "tuple of Tying"),
        ({"tying": Tying("13", r=(0.0,), s=(-1.0, 1.0))}, "tuple of Tying"),
    ],
)
def test_a_forgotten_comma(parts, words):
    with pytest.raises(InvalidValue, match=words) as caught:
        Element("own", "hex8", **parts)
    assert "with the comma" in str(caught.value)


@pytest.mark.parametrize("points", [5, (5,), ("gauss", 5)])
def test_points_of_a_plastic_law_have_a_rule(points):
    with pytest.raises(InvalidValue, match="their number and their rule"):
        Element("own", "hex8", plastic_points=points)


def linear(strain, history):
    return strain @ STIFF, np.broadcast_to(STIFF, (len(strain), 6, 6)), history


STIFF = 1000.0 * np.eye(6)


@pytest.mark.parametrize(
    ("law", "points", "modes"),
    [
        ({}, 2, 4),
        ({"thickness_points": 3}, 3, 4),
        ({"thickness_points": 5}, 5, 4),
        ({"state": {"k": 1}}, 12, 44),
        ({"state": {"k": 1}, "thickness_points": 6}, 6, 8),
    ],
)
def test_a_history_makes_a_law_plastic_and_its_points_are_honoured(law, points, modes):
    model = model_of("ANS3DEAS", UserLaw(linear, **law))
    assert (model.bodies.only.thickness_points, model.bodies.only.block.modes) == (points, modes)


@pytest.mark.parametrize(
    ("name", "membrane", "bending"),
    [
        ("DISP3D", True, False),
        ("DISP3DEAS", True, False),
        ("ANS3DEAS", True, True),
        ("EAS3DEAS", True, True),
        ("DISP9K3D", True, False),  # too stiff: no enhanced thickness strain
        ("DISP9K3DEAS", True, True),
        ("MI9K3DEAS", False, False),  # tied in-plane shear, docs/theory, 2.9
    ],
)
def test_the_patch_tests_of_the_catalogue_are_those_of_the_book(name, membrane, bending):
    check = check_element(name)
    assert check.zeros == 6
    assert (check.membrane < 1e-12) == membrane
    assert (check.bending < 1e-10) == bending
    assert max(check.membrane, check.bending) < 1e-10 or max(check.membrane, check.bending) > 1e-2
    assert check.ok() == (membrane and bending)


def test_a_reduced_element_has_mechanisms_and_fails():
    """One sampled strain in the place of four lets the cell deform without work."""
    tying = tuple(Tying(component, (0.0,), (0.0,)) for component in ("11", "22", "12", "13", "23"))
    assert check_element(Element("reduced", "hex8", tying=tying)).zeros > 6
    assert not check_element(Element("reduced", "hex8", tying=tying)).ok()
