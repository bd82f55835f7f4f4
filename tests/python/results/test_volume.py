"""Volume of a sheet: plastic flow keeps it, the mean stress changes it."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf


def stretched(material, strain=0.2, steps=8, **more):
    """A block in uniaxial tension."""
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 1.0, (2, 1)), material=material, **more)
    for nodes, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(nodes, normal)
    pull = model.prescribe("x1", "x", "pull")
    result = uf.solve(model, uf.Move(pull, 4.0 * strain, steps=steps), progress=False)
    return result, result["pull_force"][-1] * (1.0 + strain) / 1.0  # Kirchhoff stress, nearly: force times length


@pytest.mark.parametrize("name", ["J2", "Metal", "FallingModulus"])
def test_a_metal_keeps_its_volume_but_for_the_mean_stress(name):
    given = {"hardening": uf.Linear(200.0, 1000.0)}
    modulus = uf.FallingModulus(saturated=160e3, rate=40.0)
    more = {"modulus": modulus} if name == "FallingModulus" else {}
    law = uf.J2(E=210e3, nu=0.3, **given) if name == "J2" else uf.Metal(210e3, 0.3, **given, **more)
    result, stress = stretched(law)
    volume = result.volume_change()
    softer = 160.0 / 210.0 if more else 1.0
    assert volume.elastic == pytest.approx(stress / 3.0 / (softer * law.kappa), rel=3e-3)
    assert volume.strain == pytest.approx(volume.elastic, rel=1e-9)
    assert volume.mesh == pytest.approx(volume.strain, rel=1e-9)


def test_the_mesh_is_that_of_its_nodes():
    result, _ = stretched(uf.J2(E=210e3, nu=0.3, hardening=uf.Perfect(200.0)))
    x = result.model.positions
    volume = float(np.prod(np.ptp(x, axis=0)))
    assert result.volume_change().mesh == pytest.approx(volume / 4.0 - 1.0, rel=1e-9)


def test_laws_without_a_volume_of_their_own_have_none():
    result, _ = stretched(uf.SVK(E=1000.0, nu=0.3), strain=0.01, steps=1)
    volume = result.volume_change()
    assert np.isnan(volume.elastic)
    assert volume.mesh == pytest.approx(volume.strain, rel=1e-9)


@pytest.mark.parametrize(("cells", "warned"), [(1, False), (4, True)])
def test_a_mesh_that_gains_volume_is_a_warning(cells, warned):
    """A block is sheared by its height; with four elements one of them nearly turns inside out."""
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(200.0, 1000.0))
    model = uf.Model(uf.mesh.strip(3.0, 1.0, 1.0, (cells, 1)), material=steel)
    model.fix("x0")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    lift = model.prescribe("x1", "z", "lift")
    result = uf.solve(model, uf.Move(lift, 3.0, steps=20), progress=False)
    volume = result.volume_change()
    assert (abs(volume.mesh - volume.elastic) > 0.03) == warned
    found = [text for text in result.warnings if "of its volume" in text]
    assert len(found) == warned
    assert all(f"gained {100.0 * (volume.mesh - volume.elastic):.2g} %" in text for text in found)
