"""Derivatives with closed forms: load cycles of a bar, friction around a cylinder, similarity."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.shadows import solve_with_shadows

E, NU = 206e3, 0.3
BAR = {"yield": 160.0, "C1": 9000.0, "gamma1": 120.0}
#: Three cycles of the elongation of a bar of length 1, in increments.
CYCLES = np.concatenate([np.linspace(a, b, 9)[1:] for a, b in zip([0, 1, -1, 1, -1, 1], [1, -1, 1, -1, 1, -1])]) * 0.02


def bar(values):
    law = uf.Metal(
        E=E, nu=NU, hardening=uf.Perfect(values["yield"]), back_stress=uf.Chaboche(((values["C1"], values["gamma1"]),))
    )
    model = uf.Model(uf.mesh.strip(1.0, 0.5, 0.4, (1, 1)), "EAS3DEAS", material=law)
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    pull = model.prescribe("x1", "x", "pull")
    return model, [uf.Move(pull, to, steps=1) for to in CYCLES]


def forces(values):
    """Uniaxial tension by the backward Euler rule; complex values carry derivatives along."""
    stretch, plastic, back = np.log1p(CYCLES), 0.0, 0.0
    found = [0.0]
    for strain in stretch:
        trial = E * (strain - plastic)
        sign = np.sign((trial - back).real)
        step = 0.0
        if sign * (trial - back).real > values["yield"].real:
            for _ in range(50):  # sign (trial - E sign dp) - (sign back + C dp) / (1 + gamma dp) = yield
                inner = 1.0 + values["gamma1"] * step
                gap = sign * trial - E * step - (sign * back + values["C1"] * step) / inner - values["yield"]
                slope = -E - (values["C1"] - values["gamma1"] * sign * back) / inner**2
                step = step - gap / slope
        plastic = plastic + sign * step
        back = (back + values["C1"] * sign * step) / (1.0 + values["gamma1"] * step)
        stress = E * (strain - plastic)
        found.append(stress * 0.2 / np.exp(strain))  # Kirchhoff stress on the volume over the length
    return np.array(found)


def test_three_load_cycles_of_a_bar():
    """d force / d (yield, C1, gamma1) at every increment."""
    wanted = {}
    for name, value in BAR.items():
        values = {key: complex(one) for key, one in BAR.items()}
        values[name] = value + 1e-30j
        answer = forces(values)
        wanted[name] = answer.imag / 1e-30
    sizes = {(name, sign): sign * 1e-4 * value for name, value in BAR.items() for sign in (1, -1)}
    shadows = {key: bar({**BAR, key[0]: BAR[key[0]] + size}) for key, size in sizes.items()}
    found = solve_with_shadows(bar(BAR), bar(BAR), shadows, frames=0)
    answer = forces({key: complex(one) for key, one in BAR.items()}).real
    np.testing.assert_allclose(
        found.reference["pull_force"] / np.abs(answer).max(), answer / np.abs(answer).max(), atol=1e-10
    )
    for name in BAR:
        after, before = (found.shadows[name, sign]["pull_force"] for sign in (1, -1))
        own = (after - before) / (2.0 * sizes[name, 1])
        assert np.abs(own - wanted[name]).max() < 1e-6 * np.abs(wanted[name]).max(), name


def test_similarity_of_a_bend():
    """Forces are homogeneous of degree one in all stresses, and of degree two in all lengths."""
    values = {
        "E": 206e3,
        "Y": 180.0,
        "H": 900.0,
        "penalty": 500.0,
        "t": 1.0,
        "R": 20.0,
        "L": 60.0,
        "W": 10.0,
        "stroke": -6.0,
    }

    def build(E, Y, H, penalty, t, R, L, W, stroke):
        material = uf.J2(E=E, nu=0.3, hardening=uf.Linear(Y, H))
        model = uf.Model(uf.mesh.strip(L, W, t, (8, 1)), material=material)
        model.symmetry("x0", normal="x")
        model.symmetry(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), normal="y")
        punch = model.prescribe("x0_lower", "z", "punch")
        tool = uf.Cylinder((25.0 / 60.0 * L, 0.0, -R - t / 2), "y", R)
        model.contact("lower", tool, penalty=penalty, friction=0.1, cells=2, name="tool")
        return model, uf.Move(punch, stroke, steps=8)

    options = NewtonOptions(residual=1e-12)
    found = uf.derivatives(build, by=values, of=["punch_force:last"], options=options, progress=False)
    relative = {name: found["punch_force:last", name].relative for name in values}
    assert sum(relative[name] for name in ("E", "Y", "H", "penalty")) == pytest.approx(1.0, abs=1e-4)
    lengths = sum(relative[name] for name in ("t", "R", "L", "W", "stroke"))
    assert lengths - relative["penalty"] == pytest.approx(2.0, abs=3e-4)  # a pressure per length


def test_friction_around_a_cylinder():
    """T2 / T1 = exp(mu theta R / (R + t / 2)), and its derivatives, which are theta, mu and a thickness."""
    radius, width, tension = 10.0, 1.0, 1.0

    def build(mu, theta, t):
        middle = radius + 0.5 * t

        def around(X):
            angle, r = theta * X[:, 0], middle + X[:, 2]
            return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle)])

        mesh = uf.mesh.strip(1.0, width, t, (64, 1)).transformed(around)
        model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=1e5, nu=0.0))
        model.fix(np.arange(len(mesh.points)), "y")
        model.prescribe("x0", "x", "hold")
        cylinder = model.tool("cylinder", uf.Cylinder((0, 0, 0), "y", radius))
        model.contact("lower", cylinder, penalty=100.0, points="nodes", friction=mu, slip=1e-4, name="tool")
        along = np.array([np.cos(theta), 0.0, -np.sin(theta)]) / (width * t)
        load, spin = model.traction("x1", along, "tension"), model.turn(cylinder, "y", name="spin")
        return model, [uf.Move(load, tension, steps=1), uf.Move(spin, 0.02, steps=10)]

    def ratio(result):
        return float(np.log(abs(result["hold_force"][-1]) / tension))

    values = {"mu": 0.3, "theta": np.pi / 2, "t": 0.02}
    found = uf.derivatives(build, by=values, of=[ratio], options=NewtonOptions(residual=1e-11), progress=False)
    share = radius / (radius + 0.01)
    assert found["ratio", "mu"].value == pytest.approx(np.pi / 2 * share, rel=1e-4)
    assert found["ratio", "theta"].value == pytest.approx(0.3 * share, rel=1e-3)


def test_a_tool_that_closes_goes_to_the_force_of_the_run():
    """Each increment of the travel ends as a tool does that is closed with the force there."""
    height, area = 0.5, 1.0

    def build(E, gap, t, force=-50.0):
        model = uf.Model(uf.mesh.strip(2.0, 1.0, t, (2, 1)), material=uf.NeoHooke(E=E, nu=0.3))
        model.symmetry("x0", "x")
        model.symmetry("y0", "y")
        model.contact("lower", uf.Plane((0, 0, -t / 2)), penalty=1e4, name="bed")
        plate = model.contact("upper", uf.Plane((0, 0, t / 2 + gap), (0, 0, -1)), penalty=1e4, name="plate")
        return model, [uf.Close(model.press(plate, "z", "press"), force=force)]

    values = {"E": 1e3, "gap": 0.3, "t": height}
    options = NewtonOptions(residual=1e-12, increment=1e-9, max_iterations=60)
    found = uf.derivatives(build, by=values, of=[], options=options, progress=False)
    np.testing.assert_allclose(found.column("press_way", "gap")[1:], -area, rtol=1e-6)  # in the air, too
    for row in (-3, -2):
        for name in ("E", "t"):
            ends = [
                uf.solve(
                    *build(**{**values, name: values[name] * (1.0 + size)}, force=found.run["press"][row]),
                    options=options,
                    frames=0,
                )["press_way"][-1]
                for size in (1e-3, -1e-3)
            ]
            wanted = (ends[0] - ends[1]) / (2e-3 * values[name])
            assert found.column("press_way", name)[row] == pytest.approx(wanted, rel=1e-4), (row, name)


def test_the_limit_pressure_of_a_thick_tube():
    """Of perfect plasticity p = 2 Y ln(b / a) / sqrt(3): its derivative by the yield stress is p / Y."""
    inner, outer = 1.0, 2.0

    def build(Y):
        def around(X):
            phi, r = 0.5 * np.pi * X[:, 0], X[:, 2]
            return np.column_stack([r * np.sin(phi), X[:, 1], r * np.cos(phi)])

        lines = np.linspace(0.0, 1.0, 7), [0.0, 0.2], np.linspace(inner, outer, 7)
        mesh = uf.mesh.grid(*lines).transformed(around)
        metal = uf.J2(E=2e10, nu=0.3, hardening=uf.Perfect(Y))  # nearly rigid: strains, and changes of shape, are none
        model = uf.Model(mesh, "EAS3DEAS", material=metal)
        model.fix(np.arange(len(mesh.points)), "y")
        model.symmetry("x0", "x")
        model.symmetry("x1", "z")
        return model, uf.Arc(model.pressure("lower", "inside"), 200.0, increment=0.2, most=20)

    found = uf.derivatives(build, by={"Y": 200.0}, of=["inside:max"], progress=False)
    limit = found["inside:max", "Y"]
    assert limit.response.value == pytest.approx(2.0 / np.sqrt(3.0) * 200.0 * np.log(outer / inner), rel=1e-2)
    assert limit.relative == pytest.approx(1.0, rel=1e-6)
