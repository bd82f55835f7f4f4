"""Parts of the chapter on sharp bends: the section by itself, and the continuum meshes of another program."""

from __future__ import annotations

import numpy as np
import pytest

from umform_book.sharp_bends import calculix
from umform_book.sharp_bends.section import BentSection, ThicknessStrain
from umform_book.sharp_bends.thickness_strains import AVERAGED, LIMIT, LOGARITHMIC, ORDERS, STABILISED


@pytest.mark.parametrize(
    "strain", [ORDERS[3], LOGARITHMIC[2], AVERAGED[0], AVERAGED[3], STABILISED[2]], ids=lambda strain: strain.label
)
def test_tangent_of_the_section_is_the_derivative_of_its_residual(strain: ThicknessStrain) -> None:
    section = BentSection(strain, 500.0)
    for curvature in np.linspace(0.0, 0.3, 16)[1:]:
        section.bend_to(float(curvature))
    curvature, unknowns = 0.32, section.unknowns * (1.0 + 1e-3)

    def equations(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        r, K, _, _ = section._equations(curvature, u, section._stretch(curvature, u), section._thickness_strain(u))
        return r, K

    r, K = equations(unknowns)
    step = 1e-7
    differences = np.column_stack(
        [
            (equations(unknowns + step * e)[0] - equations(unknowns - step * e)[0]) / (2 * step)
            for e in np.eye(len(unknowns))
        ]
    )
    assert np.abs(r).max() > 0.0
    assert pytest.approx(differences, abs=1e-5 * np.abs(K).max()) == K


def test_free_strains_at_the_points_make_the_stress_across_the_sheet_constant() -> None:
    section = BentSection(LIMIT, 500.0)
    for curvature in np.linspace(0.0, 0.2, 21)[1:]:
        section.bend_to(float(curvature))
    E = np.zeros((len(section.z), 6))
    E[:, 0] = 0.5 * (section._stretch(section.curvature, section.unknowns) ** 2 - 1.0)
    E[:, 2] = section._thickness_strain(section.unknowns)
    # the same strain once more from the end of the last increment: no flow, the same stress
    S33 = section.law.respond(E, section.history)[0][:, 2]
    assert np.ptp(S33) < 1e-4 * np.abs(S33).max()
    mean = -section.curvature * section.moment / section.unknowns[1] ** 2
    assert S33.mean() == pytest.approx(mean, rel=1e-6)


def test_steps_of_calculix_are_read_one_after_the_other() -> None:
    line = " total force (fx,fy,fz) for set PUNCH and time  {:.7E}\n\n        0.0  0.0  {:.6E}\n"
    printed = "".join(line.format(time, force) for time, force in ((0.5, -1.0), (1.0, -2.0), (1.5, -3.0), (2.0, -4.0)))
    u, force = calculix.read_forces(printed, (0.01, 15.0))
    assert u == pytest.approx([0.0, 0.005, 0.01, 7.505, 15.0])
    assert force == pytest.approx([0.0, 10.0, 20.0, 30.0, 40.0])


@pytest.mark.parametrize("over", ["supports", "cylinder", "fold"])
def test_decks_of_calculix_have_a_first_step_where_there_is_contact(over: str) -> None:
    mesh = next(m for m in calculix.STORED if m.over == over)
    text = calculix.deck(mesh)
    contact = over != "supports"
    assert text.count("*STEP,NLGEOM") == text.count("*END STEP") == (2 if contact else 1)
    assert ("*CONTACT PAIR" in text) == contact
    assert f"PUNCH,3,3,{-mesh.stroke}" in text
