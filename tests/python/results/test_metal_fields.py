"""Fields of metals: back stress, modulus, stagnation, rolling direction, in frames, files and reports; energies."""

from __future__ import annotations

import math

import h5py
import numpy as np
import pytest

import umform as uf

STEEL = {"E": 206e3, "nu": 0.3}
CHABOCHE = uf.Chaboche([(4000.0, 80.0), (600.0, 6.0)])
SPCC = uf.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
FALLING = uf.FallingModulus(saturated=160e3, rate=30.0)


def pulled(metal, rolling=(1.0, 0.0, 0.0)):
    cube = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1))
    model = uf.Model(cube, "ANS3DEAS", material=metal, rolling=rolling)
    for name, axis in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(name, axis)
    pull = model.prescribe("x1", "x", "pull")
    return model, uf.solve(model, uf.Move(pull, to=0.05, steps=5), progress=False, frames=2)


def test_back_stress_and_modulus_of_a_bar():
    """Pulled: T - alpha is on the yield surface, the back stress has its deviator; E follows its curve."""
    metal = uf.Metal(**STEEL, hardening=uf.Linear(200.0, 500.0), back_stress=CHABOCHE, modulus=FALLING)
    _, result = pulled(metal)
    cells = result.frames[-1].cells
    p = cells["plastic_strain_max"][0]
    kirchhoff = result["pull_force"][-1] * 1.05
    assert cells["back_stress_von_mises"][0] == pytest.approx(kirchhoff - (200.0 + 500.0 * p), rel=1e-8)
    along, across = cells["back_stress"][0, 0], cells["back_stress"][0, 1:3]
    assert along == pytest.approx(2 / 3 * cells["back_stress_von_mises"][0], rel=1e-8)
    assert across == pytest.approx(-0.5 * along, rel=1e-6)
    assert cells["modulus"][0] == pytest.approx(160e3 + 46e3 * math.exp(-30.0 * p), rel=1e-12)


def test_stagnation():
    metal = uf.Metal(**STEEL, hardening=uf.Perfect(124.0), back_stress=SPCC)
    model, result = pulled(metal)
    cells, history = result.frames[-1].cells, uf.fields.point_fields(model).history
    for name in ("stagnation_radius", "bounding_growth"):
        assert cells[name].shape == (1,)
        assert cells[name] == pytest.approx(history[name].mean(), rel=1e-9)
        assert cells[name][0] > 1.0
    both = history["back_stress_1"] + history["inner_back_stress"]
    assert cells["back_stress"][0] == pytest.approx(both.mean(axis=(0, 1)), rel=1e-9, abs=1e-12)


def test_the_rolling_direction_turns_with_the_sheet():
    metal = uf.Metal(**STEEL, hardening=uf.Linear(200.0, 500.0), yield_function=uf.Hill48(1.8, 1.5, 2.2))
    cube = uf.mesh.strip(length=2.0, width=1.0, thickness=0.5, cells=(2, 1))
    model = uf.Model(cube, "ANS3DEAS", material=metal, rolling=(0.6, 0.8, 0.0))
    assert uf.fields.cell_fields(model)["rolling"] == pytest.approx(np.tile((0.6, 0.8, 0.0), (2, 1)))
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    model.u = (cube.points @ quarter.T - cube.points).ravel()
    assert uf.fields.cell_fields(model)["rolling"] == pytest.approx(np.tile((-0.8, 0.6, 0.0), (2, 1)), abs=1e-12)


def test_files_and_reports_have_them(tmp_path):
    metal = uf.Metal(
        **STEEL,
        hardening=uf.Linear(200.0, 500.0),
        yield_function=uf.Hill48(1.8, 1.5, 2.2),
        back_stress=CHABOCHE,
        modulus=FALLING,
        rate=uf.JohnsonCook(reference=1e-3, strength=0.02),
    )
    _, result = pulled(metal)
    result.write(tmp_path / "fields.vtkhdf")
    result.report(tmp_path / "report.html")
    with h5py.File(tmp_path / "fields.vtkhdf") as file:
        names: list[str] = []
        file.visit(names.append)
    last = {name.rpartition("/")[2] for name in names}
    assert {"back_stress", "back_stress_von_mises", "modulus", "rolling"} <= last
    page = (tmp_path / "report.html").read_text()
    for word in ("Hill48", "Chaboche", "FallingModulus", "JohnsonCook(reference = 0.001, strength = 0.02)"):
        assert word in page
    assert "modulus" in page


def bent(material):
    strip = uf.mesh.strip(length=6.0, width=2.0, thickness=1.0, cells=(3, 1))
    model = uf.Model(strip, "ANS3DEAS", material=material, rolling=(1, 0, 0))
    model.fix("x0")
    tip = model.prescribe("x1", "z", "tip")
    steps = [uf.Move(tip, to=1.0, steps=8, time=0.01), uf.Move(tip, to=0.0, steps=8)]
    return np.abs(uf.solve(model, steps, progress=False, frames=0).balance().drift).max()


@pytest.mark.parametrize(
    "parts",
    [
        {"back_stress": CHABOCHE},
        {"modulus": FALLING},
        {"rate": uf.CowperSymonds(40.0, 5.0)},
        {"back_stress": CHABOCHE, "modulus": FALLING, "yield_function": uf.Hill48(1.8, 1.5, 2.2)},
        {"back_stress": SPCC, "hardening": uf.Perfect(124.0)},
    ],
    ids=lambda parts: ", ".join(parts),
)
def test_the_balance_closes_as_that_of_j2(parts):
    """Bent and bent back: work is summed by trapezoids, so what is left is of the increments."""
    curve = uf.Voce(180.0, 330.0, 14.0)
    plain = bent(uf.J2(**STEEL, hardening=curve))
    assert bent(uf.Metal(**STEEL, **({"hardening": curve} | parts))) < 1.25 * plain
