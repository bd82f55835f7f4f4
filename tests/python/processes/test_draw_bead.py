"""A strip drawn through a bead of real geometry: forces, energies, thinning, files, bad input."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform.cli import app
from umform.errors import InvalidValue
from umform.processes.draw_bead import DrawBead, drawn_through
from umform.processes.draw_bead import case as case_module
from umform.processes.draw_bead.equivalent import in_deck, in_python
from umform.processes.draw_bead.extrapolation import of_two
from umform.processes.draw_bead.files import FILES, write_files
from umform.processes.draw_bead.problem import problem_of
from umform.processes.extrapolation import Limit

MILD = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(520.0, 0.004, 0.22))
SMALL = {"thickness": 1.0, "radius": 4.0, "height": 3.0, "groove_radius": 3.0, "elements": 5.0}


@pytest.fixture(scope="module")
def drawn():
    case = DrawBead(material=MILD, **SMALL)
    return drawn_through(DrawBead(material=MILD, draw=1.25 * case.through, **SMALL), frames=2, progress=False)


def test_the_work_of_the_force_goes_into_plastic_flow_and_friction(drawn):
    """Force times way against the energies of material and contact, where the force is steady."""
    assert abs(drawn.balance) < 4.0
    assert 15.0 < drawn.friction_share < 60.0
    steady = drawn.way >= drawn.case.through
    work = np.trapezoid(drawn.restraint_curve[steady], drawn.way[steady])
    assert work == pytest.approx(drawn.restraint * np.ptp(drawn.way[steady]), rel=1e-9)
    assert drawn.restraint_spread < 0.15 * drawn.restraint


def test_forces_balance_and_the_bead_lifts(drawn):
    """The tools carry what draws the strip; what pushes the one up pushes the other down."""
    result = drawn.result
    along = result["lower_tool_fx"] + result["upper_tool_fx"]
    np.testing.assert_allclose(along, result["way_force"], atol=1e-3 * drawn.restraint)
    across = result["lower_tool_fz"] + result["upper_tool_fz"]
    np.testing.assert_allclose(across, 0.0, atol=1e-3 * drawn.uplift)
    assert drawn.uplift > 0.5 * drawn.restraint and drawn.closing_force > 0.0


def test_what_comes_out_is_stretched_and_what_has_not_gone_in_is_not(drawn):
    model, case = drawn.result.model, drawn.case
    change = uf.fields.thickness_change(model)
    now = model.mesh.points[:, 0] + model.u.reshape(-1, 3)[:, 0]
    assert 0.5 < drawn.thinning < 15.0
    assert np.abs(change[now < -case.reach - 3.0]).max() < 2e-3
    length = np.ptp(now[model.mesh.points[:, 0] > -1e9]) / np.ptp(model.mesh.points[:, 0])
    assert length < 1.1  # drawn through, and not torn out


def test_the_equivalent_bead_has_its_forces(drawn):
    """In a model of flat tools the strip takes the same force."""
    line = tomllib.loads(in_deck(drawn))["beads"]["NAME"]
    forces = {key: line[key] for key in ("restraint", "uplift", "width")}
    assert forces["restraint"] == pytest.approx(drawn.restraint, rel=1e-3)
    model = uf.Model(drawn.result.model.mesh, material=MILD)
    model.fix(lambda x, y, z: y > -1.0, "y")
    pull = model.prescribe("x1", "x", "pull")
    bed = model.contact("lower", uf.Plane(), name="bed")
    model.contact("upper", uf.Plane((0, 0, 1), (0, 0, -1)), name="lid")
    assert in_python(drawn).startswith("model.bead(faces, tool, curve=[...], restraint=")
    model.bead("lower", bed, [(0, -9, 0), (0, 9, 0)], **forces)
    result = uf.solve(model, uf.Move(pull, 2.0, steps=8))
    assert result["pull_force"][-1] == pytest.approx(drawn.restraint, rel=5e-3)
    assert result["lid_fz"][-1] >= 0.99 * forces["uplift"]


def test_files(drawn, tmp_path):
    files = write_files(tmp_path, drawn, "a note")
    assert sorted(file.name for file in files) == sorted(FILES)
    record = json.loads((tmp_path / "bead.json").read_text())
    assert record["measures"]["restraint"] == drawn.restraint
    assert record["parameters"]["groove"] == drawn.case.width
    balance = record["balance"]["drawing"]
    assert balance["friction"] == drawn.result["friction_work"][-1] > 0.0
    assert balance["works"]["loads and supports"] > 0.0 and "upper_tool" in balance["works"]
    page = (tmp_path / "report.html").read_text()
    assert "a note" in page and "<h2>Balance of forces and energies</h2>" in page


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"thickness": -1.0}, "thickness"),
        ({"radius": 0.3}, "does not fit the thickness"),
        ({"groove_radius": 900.0}, "does not fit the thickness"),
        ({"height": 0.0}, "height"),
        ({"groove": 8.0}, "no room"),
        ({"gap": -0.1}, "gap"),
        ({"gap": 20.0}, "does not reach the sheet"),
        ({"friction": 12.0}, "friction"),
        ({"draw": 5.0}, "steady"),
        ({"elements": 1.0}, "quarter turn"),
        ({"contact_points": 0}, "contact points"),
        ({"material": uf.SVK(E=2e5, nu=0.3)}, "plastic"),
    ],
)
def test_parameters_that_make_no_sense_are_refused(wrong, said):
    with pytest.raises(InvalidValue, match=said):
        DrawBead(**{"material": MILD} | SMALL | wrong)


def test_the_limit_of_an_error_that_falls_with_the_square_is_exact():
    limit = Limit.of(50.0 + 3.0 / 0.7**2, 53.0, 1.0 / 0.7)
    assert limit.value == pytest.approx(50.0, rel=1e-12)
    assert limit.off == pytest.approx(0.06, rel=1e-12)


def test_two_meshes_give_the_forces_of_the_equivalent_bead(drawn, tmp_path):
    coarse = replace(drawn, case=replace(drawn.case, elements=3.5), restraint=drawn.restraint + 2.0, uplift=90.0)
    both = replace(drawn, limits=of_two(coarse, drawn))
    limit = drawn.restraint - 2.0 / (1.0 / 0.49 - 1.0)
    assert both.limits["restraint"].value == pytest.approx(limit, rel=1e-9)
    assert tomllib.loads(in_deck(both))["beads"]["NAME"]["restraint"] == pytest.approx(limit, rel=1e-3)
    row = ["restraining force", f"{limit:.1f}", "unknown", f"{drawn.restraint:.1f}", "N/mm"]
    assert both.tables["Measures"][:2] == [["quantity", "value", "error", "finest mesh", "unit"], row]


def test_two_meshes_give_the_error_of_the_limit_too():
    """The limit is exact where the error falls with the square; else two limits differ by what is left."""
    exact = Limit.of_three([54.0, 52.0, 51.0], 2.0**0.5)
    assert (exact.value, exact.error) == pytest.approx((50.0, 0.2), rel=1e-12)  # a fifth of what was extrapolated
    assert Limit.of_three([54.5, 52.0, 51.0], 2.0**0.5).error == pytest.approx(0.5, rel=1e-9)


def test_two_meshes_are_run_and_the_finest_is_kept(drawn, monkeypatch):
    """On meshes of half, 0.7 and all of the elements."""
    meshes = []

    def instead(case, *, frames, progress, **how):
        meshes.append((case.elements, frames))
        progress("step 2", 0.5, "way 1")
        of_mesh = {"restraint": 60.0 + 100.0 / case.elements**2, "uplift": 80.0, "thinning": 5.0 - 10.0 / case.elements}
        return replace(drawn, case=case, **of_mesh)

    monkeypatch.setattr(case_module, "drawn_through", instead)
    told = []
    found = case_module.extrapolated(drawn.case, frames=7, progress=lambda *tick: told.append(tick))
    shares = np.array([0.5, 0.5**0.5, 1.0])
    assert [fraction for _, fraction, _ in told] == pytest.approx((np.cumsum(shares) - 0.75 * shares) / shares.sum())
    assert [elements for elements, _ in meshes] == pytest.approx([2.5, 5.0 / 2.0**0.5, 5.0])
    assert [frames for _, frames in meshes] == [0, 0, 7]
    assert found.forces == pytest.approx((60.0, 80.0), rel=1e-12)
    assert found.tables["Measures"][1][2] == "± 0.8"  # a fifth of 100 / 25
    assert found["restraint"].band.error == pytest.approx(0.8) and found["friction_share"].band is None
    assert found["thinning"].band.middle == pytest.approx(5.0)  # falls with the length of the elements


def test_a_mesh_that_is_too_coarse_to_be_coarsened_is_refused(drawn, monkeypatch):
    monkeypatch.setattr(case_module, "drawn_through", lambda case, **how: replace(drawn, case=case))
    with pytest.raises(InvalidValue, match="coarsest of three") as refused:
        case_module.extrapolated(replace(drawn.case, elements=3.0))
    assert (refused.value.where, refused.value.value) == ("elements", "3") and "--no-extrapolate" in str(refused.value)
    assert case_module.extrapolated(replace(drawn.case, elements=4.0), progress=False).case.elements == 4.0


@pytest.mark.parametrize("elements", [3.0, 30.0])
def test_a_tool_may_penetrate_by_half_the_rise_of_an_arc_over_an_element(drawn, elements):
    """Eq. (4.190); 1/200 of the thickness at least. The run has kept it."""
    case = replace(drawn.case, elements=elements)
    assert case.allowed == pytest.approx(max((0.5 * np.pi * 3.0 / elements) ** 2 / 16.0 / 3.0, 1.0 / 200.0))
    pairs, result = drawn.result.model.contacts, drawn.result
    assert max(result[f"{pair.name}_penetration"].max() for pair in pairs) <= drawn.case.allowed


def test_a_bead_is_run_in_plane_strain_with_its_own_options(drawn, monkeypatch):
    assert drawn.result.model.bodies.only.element.plane_strain
    assert replace(drawn.case, material=uf.sheet_metals.get("AA6016-T4").law, rolling=45.0).plane_strain is None
    asked = {}
    monkeypatch.setattr(case_module, "solve", lambda model, steps, **how: asked.update(how) or drawn.result)
    case_module.drawn_through(drawn.case, progress=False)
    assert asked["options"] == drawn.case.newton == problem_of(drawn.case).build().options
    assert (asked["options"].residual, asked["options"].keep) == (1e-4, True)


def test_a_shallow_bead_has_no_walls_and_a_high_one_has():
    shallow, high = DrawBead(material=MILD, **SMALL), DrawBead(material=MILD, **SMALL | {"height": 6.0})
    assert len(shallow.profile.segments) == 3 and len(high.profile.segments) == 5
    for case in (shallow, high):
        gap = case.upper_tool.kernel().gap(np.array([[0.0, 0.0, 1.0], [20.0, 0.0, 1.0]]))[0]
        np.testing.assert_allclose(gap, [0.0, case.height], atol=1e-12)


@pytest.mark.parametrize(
    "typed", [["--friction", "-1"], ["--draw", "5"], ["--radius", "nan"], ["--material", "cheese"]]
)
def test_the_command_refuses_before_anything_runs(typed, tmp_path):
    done = CliRunner().invoke(app, ["bead", *typed, "--out", str(tmp_path / "out")])
    assert done.exit_code == 1 and not (tmp_path / "out").exists()
    assert typed[1] in done.stderr and "remedy:" in done.stderr
