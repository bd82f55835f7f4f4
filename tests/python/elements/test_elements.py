"""Every element of the catalogue with every material: tangent, rigid motions, objectivity; options and rules."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Legendre

import umform as uf
from umform import _core, elements
from umform import materials as mt
from umform.elements import CATALOGUE, Element, Mode, Tying, element, thickness_rule
from umform.elements.staggered import section_rule
from umform.errors import InvalidValue
from umform.history_variables import history_of
from umform.mesh import strip
from umform.model import Model

LAWS = ("svk", "neo-hooke", "neo-hooke-power", "j2")
FOR_BENDS = ("BEND8", "BEND18")
ENHANCED = [name for name in CATALOGUE if name.endswith("EAS") or name in FOR_BENDS]


def options_of(name):
    """The ways of E_33: tied or not, order 1 and 3 where the element has an enhanced thickness strain."""
    if name in FOR_BENDS:  # they have settled it
        yield {}
        return
    orders = (1, 3) if name in ENHANCED else (None,)
    for tie, order in itertools.product((False, True), orders):
        yield {"tie_E33": tie} | ({} if order is None else {"thickness_order": order})


VARIANTS = [
    pytest.param(name, options, id="-".join([name, *(f"{key}-{value}" for key, value in options.items())]))
    for name in CATALOGUE
    for options in options_of(name)
] + [
    pytest.param("EAS3DEAS", {"membrane_modes": 4}, id="EAS3DEAS-4-modes"),
    pytest.param("EAS3DEAS", {"membrane_modes": 5}, id="EAS3DEAS-5-modes"),
    pytest.param("ANS3DEAS", {"thickness_modes": 1}, id="ANS3DEAS-1-mode"),
    pytest.param("ANS3DEAS", {"thickness_order": 4}, id="ANS3DEAS-order-4"),
    pytest.param("ANS3DEAS", {"thickness_order": 3, "order_modes": 4}, id="ANS3DEAS-order-3-times-4"),
    pytest.param("MI9K3DEAS", {"thickness_modes": 4}, id="MI9K3DEAS-4-modes"),
    pytest.param("MI9K3DEAS", {"thickness_order": 3, "order_modes": 1}, id="MI9K3DEAS-order-3-times-1"),
    pytest.param(
        "MI9K3DEAS", {"thickness_order": 3, "order_modes": 9, "tie_E33": True}, id="MI9K3DEAS-order-3-times-9-tied"
    ),
    pytest.param("MI9K3DEAS", {"compatible_E12": True}, id="MI9K3DEAS-compatible-E12"),
]  # fmt: skip

every_element = pytest.mark.parametrize(("name", "options"), VARIANTS)
every_law = pytest.mark.parametrize("law", LAWS)


@pytest.fixture
def strained(build, materials):
    """A distorted element in a strained state; with history, and plastic, if the law has one."""

    def make(name, law, options):
        one = build.one_element(name, materials[law], **options)
        u = one.displacement()
        if law == "j2":
            one.harden(u)
            assert (history_of(one.block)["eqps"] > 0.005).mean() > 0.9
            u = u + one.displacement(0.2)
        return one, u

    return make


@every_element
@every_law
def test_tangent_is_the_derivative_of_the_force(build, strained, name, law, options):
    one, u = strained(name, law, options)
    K, _ = one(u)
    for _ in range(3):
        du = one.rng.normal(size=u.size)
        slope = build.central_difference(lambda v: one(v)[1], u, du)
        assert build.relative_error(K @ du, slope) < 1e-7


@every_element
@every_law
def test_scattered_tangent_is_symmetric_and_that_of_the_element(build, strained, name, law, options):
    one, u = strained(name, law, options)
    K, f = one(u)
    assert (K == K.T).all()
    force, values = np.zeros(u.size), np.zeros(one.pattern.indices.size)
    du, Kdu = one.rng.normal(size=u.size), np.zeros(u.size)
    failed, scale, _ = one.block.evaluate(u, one.scatter, force, values, du, Kdu)
    assert failed == -1
    assert scale == pytest.approx(f @ f, rel=1e-12)
    np.testing.assert_allclose(force, f, atol=1e-12 * np.abs(f).max())
    np.testing.assert_array_equal(build.dense(one.pattern, values), K)
    np.testing.assert_allclose(Kdu, K @ du, atol=1e-12 * np.abs(Kdu).max())


@every_element
def test_tangent_of_a_general_pattern_is_symmetric_too(build, materials, name, options):
    """The full matrix goes through another scatter than the upper triangle."""
    one = build.one_element(name, materials["svk"], **options)
    u = one.displacement()
    K, _ = one(u)
    full = build.full_tangent(one.block, one.nodes)
    np.testing.assert_array_equal(full(u)[1], K)


@every_element
@every_law
def test_exactly_six_zero_modes(build, materials, rotation, name, law, options):
    one = build.one_element(name, materials[law], **options)
    at_rest = np.zeros(3 * one.nodes)
    for u in (at_rest, one.rotated(at_rest, rotation)):
        K, f = one(u)
        values, modes = np.linalg.eigh(K)
        assert np.abs(f).max() < 1e-12 * values.max()
        assert (np.abs(values) < 1e-11 * values.max()).sum() == 6
        assert values.min() > -1e-11 * values.max()
        x = one.X + u.reshape(-1, 3)
        rigid = [np.tile(e, one.nodes) for e in np.eye(3)] + [np.cross(e, x).ravel() for e in np.eye(3)]
        zero = modes[:, np.abs(values) < 1e-11 * values.max()]
        for mode in rigid:
            mode = mode / np.linalg.norm(mode)
            assert np.linalg.norm(mode - zero @ (zero.T @ mode)) < 1e-5


@every_element
@every_law
def test_a_superposed_rigid_motion_only_turns_the_forces(strained, rotation, name, law, options):
    one, u = strained(name, law, options)
    K, f = one(u)
    E, S, frame, F, dV = one.block.point_fields(u)
    turned = one.rotated(u, rotation)
    K_turned, f_turned = one(turned)
    Q = np.kron(np.eye(one.nodes), rotation)
    np.testing.assert_allclose(f_turned, Q @ f, atol=1e-9 * np.abs(f).max())
    np.testing.assert_allclose(K_turned, Q @ K @ Q.T, atol=1e-9 * np.abs(K).max())
    E2, S2, frame2, F2, dV2 = one.block.point_fields(turned)
    assert (S2 * E2 * dV2[..., None]).sum() == pytest.approx((S * E * dV[..., None]).sum(), rel=1e-9)
    np.testing.assert_allclose(E2, E, atol=1e-9 * np.abs(E).max())
    np.testing.assert_allclose(S2, S, atol=1e-9 * np.abs(S).max())
    np.testing.assert_allclose(F2, rotation @ F, atol=1e-12)
    np.testing.assert_array_equal(frame2, frame)


@every_element
def test_forces_of_an_element_are_in_equilibrium(strained, name, options):
    one, u = strained(name, "neo-hooke", options)
    f = one(u)[1].reshape(-1, 3)
    x = one.X + u.reshape(-1, 3)
    assert np.abs(f.sum(axis=0)).max() < 1e-12 * np.abs(f).max()
    assert np.abs(np.cross(x, f).sum(axis=0)).max() < 1e-12 * np.abs(f).max()


@pytest.mark.parametrize("name", CATALOGUE)
def test_internal_work_is_the_work_of_the_nodal_forces(build, materials, name):
    """Along a closed loop of displacements an elastic element gives back what it took."""
    one = build.one_element(name, materials["neo-hooke"])
    a, b = one.displacement(0.5), one.displacement(0.5)
    angle, weight = 2 * np.pi * np.arange(24) / 24, 2 * np.pi / 24
    work = [one(np.cos(t) * a + np.sin(t) * b)[1] @ (-np.sin(t) * a + np.cos(t) * b) * weight for t in angle]
    assert abs(sum(work)) < 1e-8 * sum(abs(w) for w in work)


@pytest.mark.parametrize("name", CATALOGUE)
def test_shorten_and_revert_take_the_parameters_back(build, materials, name):
    one = build.one_element(name, materials["neo-hooke"])
    u = one.displacement()
    before, du = one.block.element(0, u), one.displacement(0.1)

    def evaluate_and_recover():
        f, values = np.zeros(u.size), np.zeros(one.pattern.indices.size)
        one.block.evaluate(u, one.scatter, f, values, None, None)
        one.block.recover(du)

    evaluate_and_recover()
    changed = one.block.element(0, u)
    assert (one.block.modes == 0) == (changed[1] == before[1]).all()
    one.block.shorten(0.0)
    np.testing.assert_array_equal(one.block.element(0, u)[0], before[0])
    evaluate_and_recover()
    evaluate_and_recover()
    one.block.revert()
    np.testing.assert_array_equal(one.block.element(0, u)[0], before[0])
    np.testing.assert_array_equal(one.block.element(0, u)[1], before[1])


@pytest.mark.parametrize("name", ["EAS3DEAS", "MI9K3DEAS"])
def test_shorten_takes_a_part_of_the_change_of_the_parameters(build, materials, name):
    one = build.one_element(name, materials["neo-hooke"])
    u, du = one.displacement(), one.displacement(0.1)

    def parameters(*parts):
        one.block.restore(one.block.state, np.zeros_like(one.block.alpha))
        one.block.evaluate(u, one.scatter, np.zeros(u.size), np.zeros(one.pattern.indices.size), None, None)
        one.block.recover(du)
        for part in parts:
            one.block.shorten(part)
        one.block.commit()
        return one.block.alpha.copy()

    whole = parameters()
    assert np.abs(whole).max() > 0
    np.testing.assert_allclose(parameters(0.5, 0.25), 0.125 * whole, rtol=1e-14)


def test_recover_solves_for_the_parameters_after_a_linear_step(build, materials):
    """For a linear law and a tiny displacement one recovery makes the parameters stationary."""
    one = build.one_element("EAS3DEAS", materials["svk"])
    u = one.displacement(1e-9)
    f, values = np.zeros(u.size), np.zeros(one.pattern.indices.size)
    one.block.evaluate(np.zeros(u.size), one.scatter, f, values, None, None)
    one.block.recover(u)
    once = one.block.element(0, u)[1]
    settled = one(u)[1]
    assert np.abs(once - settled).max() < 1e-7 * np.abs(settled).max()


def test_an_element_squeezed_to_a_point_names_the_cell(build, materials):
    one = build.one_element("ANS3DEAS", materials["neo-hooke"])
    f, values = np.zeros(24), np.zeros(one.pattern.indices.size)
    squeezed = -one.X.ravel()
    failed, _, why = one.block.evaluate(squeezed, one.scatter, f, values, None, None)
    assert failed == 0
    assert "turned inside out" in why
    with pytest.raises(ValueError, match="cell 0 is turned inside out"):
        one.block.element(0, squeezed)


# The catalogue ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_entry_of_the_catalogue_is_cited_and_has_its_nodes(name):
    made = element(name)
    assert made.name == name
    assert made.citation
    assert made.nodes == (18 if "9K" in name or name == "BEND18" else 8)
    assert made.surface_points == (3 if made.nodes == 18 else 2)
    assert (made.thickness_order > 0) == (name in ENHANCED)


@pytest.mark.parametrize(
    ("name", "options", "modes"),
    [
        ("DISP3D", {}, 0),
        ("DISP3DEAS", {}, 4),
        ("ANS3DEAS", {"thickness_modes": 1}, 1),
        ("ANS3DEAS", {"thickness_order": 3}, 6),
        ("EAS3DEAS", {}, 11),
        ("EAS3DEAS", {"membrane_modes": 5, "thickness_order": 2}, 10),
        ("MI9K3DEAS", {}, 9),
        ("MI9K3DEAS", {"thickness_modes": 4}, 4),
        ("BEND8", {}, 4 + 3),
        ("BEND18", {}, 9 * 4),
    ],
)
def test_number_of_enhanced_modes(name, options, modes):
    assert len(element(name, **options).modes) == modes


@pytest.mark.parametrize(("name", "base"), [("BEND8", "ANS3DEAS"), ("BEND18", "MI9K3DEAS")])
def test_the_elements_for_bends_are_order_4_with_tying(name, base):
    assert element(name) == replace(element(base, thickness_order=4, tie_E33=True), name=name, complete=True)
    assert element(name, thickness_order=1, tie_E33=False) == replace(element(base), name=name, complete=False)


@pytest.mark.parametrize(
    ("name", "given", "through"),
    [
        ("DISP3D", {}, (5, "gauss")),
        ("ANS3DEAS", {}, (12, "staggered")),
        ("ANS3DEAS", {"thickness_rule": "lobatto"}, (18, "lobatto")),
        ("BEND8", {}, (12, "staggered")),
        ("BEND8", {"thickness_order": 12}, (14, "staggered")),
        ("BEND8", {"plane_strain": True}, (20, "staggered")),
        ("BEND8", {"thickness_points": 9}, (9, "gauss")),
        ("BEND8", {"thickness_rule": "gauss"}, (18, "gauss")),
        ("BEND18", {}, (18, "staggered")),
        ("BEND18", {"thickness_rule": "graded"}, (18, "graded")),
        ("DISP3D", {"thickness_rule": "staggered"}, (12, "staggered")),
    ],
)
def test_points_through_the_thickness_that_a_plastic_law_gets(name, given, through):
    cell = element(name).cell
    steel = uf.J2(kappa=175e3, mu=80e3, hardening=uf.Perfect(160.0))
    model = uf.Model(uf.mesh.strip(2, 1, 1, (2, 1), cell=cell), name, material=steel, **given)
    assert (model.bodies.only.thickness_points, model.bodies.only.thickness_rule) == through


@pytest.mark.parametrize(
    ("name", "given", "order"),
    [
        ("ANS3DEAS", {}, 11),
        ("MI9K3DEAS", {}, 17),
        ("EAS3DEAS", {"thickness_points": 5}, 4),
        ("ANS3DEAS", {"thickness_order": 1}, 1),
        ("BEND8", {"thickness_order": 4}, 4),
        ("BEND8", {"thickness_points": 15}, 14),
        ("DISP3D", {}, 0),
    ],
)
def test_a_plastic_law_gets_the_complete_order(name, given, order):
    steel = uf.J2(kappa=175e3, mu=80e3, hardening=uf.Perfect(160.0))
    model = uf.Model(uf.mesh.strip(2, 1, 1, (2, 1), cell=element(name).cell), name, material=steel, **given)
    orders = {part.c for mode in model.bodies.only.element.modes for part in mode.polynomials if part.component == "33"}
    assert orders == set(range(1, order + 1))
    assert model.bodies.only.element.thickness_order == order


@pytest.mark.parametrize("name", ["ANS3DEAS", "MINE"])
def test_modes_of_ones_own_are_completed_unless_the_element_says_no(name):
    mine = replace(element("ANS3DEAS"), name=name, modes=elements.thickness_modes(1, 1))
    steel, sheet = uf.J2(kappa=175e3, mu=80e3, hardening=uf.Perfect(160.0)), uf.mesh.strip(2, 1, 1, (2, 1))
    assert uf.Model(sheet, mine, material=steel).bodies.only.element.modes == elements.column_modes((2, 2), 11)
    graded = uf.Model(sheet, mine, material=steel, thickness_rule="graded")
    assert graded.bodies.only.element.modes == elements.thickness_modes(1, 17)
    as_given = replace(mine, complete=False)
    assert uf.Model(sheet, as_given, material=steel).bodies.only.element == as_given


def test_elastic_laws_need_no_more_points_than_the_order_asks_for():
    model = uf.Model(uf.mesh.strip(2, 1, 1, (2, 1)), "BEND8", material=uf.SVK(E=1.0, nu=0.3))
    assert (model.bodies.only.thickness_points, model.bodies.only.thickness_rule) == (5, "gauss")


@pytest.mark.parametrize(("name", "linear"), [("ANS3DEAS", 4), ("MI9K3DEAS", 9), ("DISP9K3DEAS", 9)])
@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("order_modes", [1, 4, 9])
def test_higher_orders_in_the_thickness_come_with_as_many_modes_as_asked(name, linear, order, order_modes):
    options = {"thickness_order": order, "order_modes": order_modes}
    if name == "ANS3DEAS" and order_modes == 9:
        with pytest.raises(InvalidValue, match="cannot tell nine"):
            element(name, **options)
        return
    made = element(name, **options)
    orders = [mode.polynomials[0].c for mode in made.modes]
    assert all(part.c == order for mode, order in zip(made.modes, orders, strict=True) for part in mode.polynomials)
    assert [orders.count(c) for c in range(order + 1)] == [0, linear, *([order_modes] * (order - 1))]
    assert len(made.modes) == linear + (order - 1) * order_modes
    assert made.options["order_modes"] == order_modes
    made.check_modes(*thickness_rule(order + 1))


@pytest.mark.parametrize(("name", "modes"), [("ANS3DEAS", 6), ("EAS3DEAS", 13), ("MI9K3DEAS", 27), ("DISP9K3DEAS", 27)])
def test_higher_orders_vary_in_the_surface_of_18_nodes_by_default(name, modes):
    assert len(element(name, thickness_order=3).modes) == modes


@pytest.mark.parametrize("name", ["MI9K3DEAS", "DISP9K3DEAS", "BEND18"])
def test_nine_modes_of_an_order_act_at_a_point_of_the_surface_each(name):
    made, x = element(name), _core.gauss(3)[0]
    s, r = (grid.ravel() for grid in np.meshgrid(x, x, indexing="ij"))
    t, orders = np.full(9, 0.3), made.thickness_order
    values = np.array([mode(r, s, t) for mode in made.modes]).reshape(9, orders, 9)
    legendre = [Legendre.basis(order)(0.3) for order in range(1, orders + 1)]
    for point in range(9):
        np.testing.assert_allclose(values[point], np.outer(legendre, np.arange(9) == point), atol=1e-14)


def test_nine_modes_span_all_biquadratic_polynomials():
    r, s, t = np.random.default_rng(3).uniform(-1.0, 1.0, (3, 40))
    modes = np.array([mode(r, s, t) for mode in element("MI9K3DEAS").modes])
    monomials = np.array([t * r**a * s**b for a in range(3) for b in range(3)])
    assert np.linalg.matrix_rank(np.concatenate([modes, monomials]), tol=1e-10) == 9


@pytest.mark.parametrize("order_modes", [0, 2, 3, 16])
def test_unknown_numbers_of_modes_of_higher_order_are_refused(order_modes):
    with pytest.raises(InvalidValue, match="each order above 1 must be 1, 4 or 9"):
        element("MI9K3DEAS", thickness_order=2, order_modes=order_modes)


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("DISP3D", {"thickness_order": 3}),
        ("DISP9K3D", {"thickness_modes": 4}),
        ("ANS3DEAS", {"thickness_order": 20}),
        ("ANS3DEAS", {"thickness_order": 0}),
        ("ANS3DEAS", {"thickness_modes": 3}),
        ("ANS3DEAS", {"membrane_modes": 4}),
        ("EAS3DEAS", {"membrane_modes": 6}),
        ("ANS3DEAS", {"compatible_E12": True}),
        ("ANS4DEAS", {}),
    ],
)
def test_options_that_do_not_belong_to_the_element_are_refused(name, options):
    with pytest.raises(InvalidValue):
        element(name, **options)


def test_an_unknown_element_is_answered_with_the_catalogue():
    with pytest.raises(InvalidValue) as caught:
        element("ANS")
    assert all(name in caught.value.remedy for name in CATALOGUE)


def test_an_element_of_ones_own_equals_its_sister_in_the_catalogue(build, materials):
    """Rows written by hand: the assumed shear of Bathe and Dvorkin and four thickness modes."""
    mine = Element(
        "MINE",
        "hex8",
        tying=(Tying("13", (0.0,), (-1.0, 1.0)), Tying("23", (-1.0, 1.0), (0.0,))),
        modes=tuple(Mode("33", a, b, 1) for b in (0, 1) for a in (0, 1)),
        thickness_order=1,
    )
    assert element(mine) is mine
    with pytest.raises(InvalidValue, match="no further options"):
        element(mine, tie_E33=True)
    one, other = build.one_element(mine, materials["svk"]), build.one_element("ANS3DEAS", materials["svk"])
    u = one.displacement()
    np.testing.assert_array_equal(one(u)[0], other(u)[0])


LINEAR = Mode("33", c=1)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"cell": "hex20"}, "hex8 or hex18"),
        ({"tying": (Tying("31", (0.0,), (0.0,)),)}, "one component"),
        ({"tying": (Tying("13", (0.0,), (-1.0, 1.0)), Tying("13", (-1.0, 1.0), (0.0,)))}, "one component"),
        ({"tying": (Tying("13", (-1.0, -1.0), (0.0,)),)}, "each once"),
        ({"tying": (Tying("13", (0.0,), (1.0, 0.0, 1.0)),)}, "each once"),
        ({"tying": (Tying("13", (), (0.0,)),)}, "one at least"),
        ({"tying": (Tying("13", (np.nan,), (0.0,)),)}, "finite numbers"),
        ({"modes": (Mode("11", -1),)}, "whole numbers from 0"),
        ({"modes": (Mode("11", 1.5),)}, "whole numbers from 0"),
        ({"modes": (Mode("11", 1, factor=np.nan),)}, "a finite factor"),
        ({"modes": (LINEAR, Mode("44", c=1))}, "a strain component"),
        ({"modes": (LINEAR, ())}, "tuple of Mode"),
        ({"modes": (Mode("33"),)}, "mean"),
        ({"modes": (LINEAR, Mode("11", 2))}, "mean"),
        ({"modes": (Mode("11", 2, 2) + Mode("11", factor=-1.0),)}, "mean"),
        ({"modes": (Mode("11", 2) + Mode("22", factor=-1 / 3),)}, "mean"),  # zero only over both components
    ],
)
def test_elements_that_are_none_are_refused(parts, message):
    with pytest.raises(InvalidValue, match=message) as caught:
        Element(**({"name": "MINE", "cell": "hex8"} | parts))
    assert caught.value.where == "MINE"


def test_a_mode_may_be_freed_of_its_mean_by_another_one():
    Element("MINE", "hex18", modes=(Mode("11", 2) + Mode("11", factor=-1 / 3), Mode("33", 2, 0, 2)))


def model_of(made, **options):
    return Model(strip(1.0, 1.0, 0.1, (1, 1), cell=made.cell), made, material=mt.SVK(E=1.0, nu=0.0), **options)


def test_modes_that_the_gauss_points_cannot_tell_apart_are_refused_by_the_model():
    """At 2 x 2 points r² and s² are constants: five of the nine modes repeat the others."""
    made = replace(element("ANS3DEAS"), modes=elements.thickness_modes(9, 1))
    with pytest.raises(InvalidValue, match="linearly dependent") as caught:
        model_of(made)
    assert caught.value.where == "ANS3DEAS"
    assert "9 modes, 2 x 2 x 2 points" in caught.value.value
    model_of(replace(made, modes=elements.thickness_modes(4, 1)))
    model_of(replace(element("MI9K3DEAS"), modes=elements.thickness_modes(9, 1)))


def test_a_mode_given_twice_and_an_order_without_its_points_are_refused_by_the_model():
    with pytest.raises(InvalidValue, match="linearly dependent"):
        model_of(Element("MINE", "hex8", modes=(LINEAR, Mode("33", c=1, factor=-2.0))))
    cubic = Element("MINE", "hex8", modes=(LINEAR, Mode("33", c=3)))
    with pytest.raises(InvalidValue, match="at least 4 thickness points"):
        model_of(cubic, thickness_points=3)  # P_3 vanishes at its own Gauss points
    model_of(cubic, thickness_points=4)


@pytest.mark.parametrize("rule", ["gauss", "lobatto", "split"])
@pytest.mark.parametrize("points", range(2, 21))
def test_thickness_rules_integrate_as_far_as_they_promise(rule, points):
    if rule == "split" and points % 2:
        with pytest.raises(InvalidValue, match="even"):
            thickness_rule(points, rule)
        return
    t, w = thickness_rule(points, rule)
    assert len(t) == len(w) == points
    assert (np.diff(t) > 0).all()
    np.testing.assert_allclose(t, -t[::-1], atol=1e-15)
    degree = {"gauss": 2 * points - 1, "lobatto": 2 * points - 3, "split": points - 1}[rule]
    for k in range(degree + 1):
        assert w @ t**k == pytest.approx(2 / (k + 1) if k % 2 == 0 else 0.0, abs=1e-13)
    if rule == "split":
        assert w @ np.abs(t) == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("points", [8, 10, 12, 16, 18, 20])
def test_graded_points_are_exact_on_each_half_and_dense_at_the_faces(points):
    t, w = thickness_rule(points, "graded")
    assert (np.diff(t) > 0).all()
    assert (w > 0).all()
    np.testing.assert_array_equal(t, -t[::-1])
    for k in range(points // 2 if points <= 12 else 4):
        assert w[points // 2 :] @ t[points // 2 :] ** k == pytest.approx(1 / (k + 1), abs=1e-14)
    steps = np.diff(t[points // 2 :])
    assert steps[-1] < 0.6 * steps[0]


def test_the_default_points_find_the_permanent_curvature_of_a_perfectly_plastic_strip():
    """One border of flow at 1/k, eq. (2.49): within 3 % at every curvature from 1.1 times the yield moment on."""
    made = element("ANS3DEAS")
    t, w = section_rule(made.plastic_rule[0], made.surface_rule)
    k = np.linspace(1.12, 25.0, 4000)
    exact = k - (1.5 - 0.5 / k**2)
    moments = 1.5 * np.clip(np.outer(k, t), -1.0, 1.0) @ (w * t)
    assert np.abs((k - moments) / exact - 1.0).max() < 0.03
    t, w = thickness_rule(12, "graded")
    moments = 1.5 * np.clip(np.outer(k, t), -1.0, 1.0) @ (w * t)
    assert np.abs((k - moments) / exact - 1.0).max() > 0.05


@pytest.mark.parametrize(
    ("points", "rule"),
    [(1, "gauss"), (21, "gauss"), (4, "simpson"), (11, "graded"), (11, "staggered"), (4, "staggered")],
)
def test_thickness_rules_out_of_range_are_refused(points, rule):
    with pytest.raises(InvalidValue):
        thickness_rule(points, rule)


def test_modes_of_the_membrane_have_no_mean():
    """The enhanced strains must do no work on constant stresses: their integral over the square vanishes."""
    x, w = thickness_rule(3)
    for count in (4, 5, 7):
        for mode in elements.membrane_modes(count):
            for component in {part.component for part in mode.polynomials}:
                parts = [part for part in mode.polynomials if part.component == component]
                total = sum(part.factor * (w @ x**part.a) * (w @ x**part.b) for part in parts)
                assert total == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("name", ["ANS3DEAS", "BEND8", "MI9K3DEAS"])
@pytest.mark.parametrize("points", [8, 12, 20])
def test_a_constant_stress_through_the_thickness_does_no_work_on_the_modes(name, points):
    """Modes have no mean under the graded rule, whose degree is below theirs: the forces are exact."""
    law = mt.J2(E=100.0, nu=0.25, hardening=mt.Perfect(1e6))
    mesh = strip(2.0, 1.0, 0.5, (1, 1), cell=element(name).cell)
    model = Model(mesh, name, material=law, thickness_points=points, thickness_rule="graded")
    u = np.zeros_like(mesh.points)
    u[:, 2] = 1e-6 * mesh.points[:, 2]
    found = model.evaluate(u.ravel()).residual.reshape(-1, 3)[mesh.points[:, 2] > 0.0, 2].sum()
    confined = 100.0 * 0.75 / (1.25 * 0.5)
    assert found == pytest.approx(2.0 * confined * 1e-6, rel=1e-5)
