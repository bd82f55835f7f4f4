"""Cups and U-bends: parameters, sizes, tools, a run, its files, and how it may end."""

import json
from dataclasses import dataclass, replace
from functools import cache
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from matplotlib import pyplot as plt
from typer.testing import CliRunner

import umform as uf
from umform.analysis.steps.pace import Happened
from umform.cli import app
from umform.errors import InvalidValue
from umform.processes.air_bending.spec import dc04_like
from umform.processes.draw import Cup, Drawn, UBend, draw, write_files
from umform.processes.draw.drawn import FORCE, FORCE_OFF
from umform.processes.draw.endings import ending_of
from umform.processes.draw.files import draw_blank
from umform.processes.draw.outcome import names_of
from umform.processes.draw.pictures import limits, pictures, sections
from umform.processes.draw.spec import coarse
from umform.processes.draw.u_bend import NUMISHEET
from umform.processes.draw.words import before_the_run
from umform.processes.solution import drawing_options
from umform.results.forming import BY_PATHS, ear_profile, passage

STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(565.3, 0.0071, 0.259))
CUP = Cup(
    thickness=1.0,
    blank_radius=40.0,
    material=STEEL,
    punch_radius=25.0,
    punch_edge=6.0,
    die_radius=26.4,
    die_edge=6.0,
    holder_force=20e3,
    stroke=6.0,
    turn=45.0,
    around=4,
    penalty=3e3,
)
U = UBend(
    thickness=0.78,
    length=200.0,
    width=35.0,
    material=STEEL,
    punch_width=50.0,
    punch_edge=5.0,
    opening=52.0,
    die_edge=5.0,
    holder_force=2450.0,
    stroke=20.0,
    element="BEND8",
    turn=30.0,
    contact_points=3,
    penalty=1000.0,
)


class History(dict):
    """Columns of a run that was not made."""


@cache
def cup():
    return draw(CUP, frames=3, progress=False)


def test_distance_blocks_and_bands_in_mm_follow_the_thickness():
    """The blocks give a two-hundredth of the thickness under the force; forces grow with the square of the lengths."""
    thick = replace(
        CUP,
        holder_force=8.0**2 * CUP.holder_force,
        **{one: 8.0 * getattr(CUP, one) for one in ("thickness", "blank_radius", "punch_radius", "punch_edge")},
        **{one: 8.0 * getattr(CUP, one) for one in ("die_radius", "die_edge", "stroke")},
    )
    for case in (CUP, thick):
        (stop,) = case.problem().contents.controls["hold"].stops
        assert stop.stiffness * case.thickness / 200.0 == pytest.approx(case.holder_force / case.parts)
        assert stop.at == pytest.approx(1e-5 * case.thickness)
    lengths = [replace(cup(), case=case).studied.length for case in (CUP, thick, U, replace(U, element="BEND18"))]
    assert lengths == [1.0, 8.0, U.thickness, U.thickness]


def test_a_cup_is_symmetric_and_in_balance():
    drawn = cup()
    assert drawn.ending is None
    model, result = drawn.result.model, drawn.result
    x = model.mesh.displaced(drawn.u)
    order = {tuple(np.round(p, 6)): k for k, p in enumerate(model.mesh.points)}
    mirrored = [order[tuple(np.round(p, 6))] for p in model.mesh.points[:, [1, 0, 2]]]
    np.testing.assert_allclose(x[mirrored][:, [1, 0, 2]], x, atol=2e-3)  # staggered heights are not mirrored
    forces = result["punch_fz"] + result["die_fz"] + result["holder_fz"]
    assert abs(forces).max() < drawing_options().residual * abs(result["die_fz"]).max()
    assert abs(result.balance().drift[-1]) < 0.02
    assert drawn.forces["holder"][-1] == pytest.approx(20e3, rel=1e-6)


def test_the_gauge_of_a_cup_keeps_its_symmetry():
    """It may carry a force while the punch still holds the part."""
    tools = {"punch_radius": 30.0, "punch_edge": 5.0, "die_radius": 31.2, "die_edge": 10.0}
    model, press = replace(CUP, blank_radius=53.75, turn=30.0, around=8, **tools).build()
    x = model.mesh.points[press.opening[0].on.nodes]
    assert len(x) == 1
    np.testing.assert_allclose(x[:, :2], 0.0, atol=1e-9)


def test_measures_of_a_cup():
    drawn = cup()
    rows = drawn.values
    loaded = ear_profile(drawn.result.model.mesh, drawn.u)
    assert 7.0 < loaded.mean < 8.0  # stroke and thickness, and the bottom bulges away from the flat of the punch
    assert 0 < rows["draw-in, mean"] < 3
    assert rows["margin to the forming limit"] > 0
    assert drawn.released is not None
    assert abs(drawn.released["die_fz"][-1]) < 1e-9
    assert 0 < drawn.springback.largest < 0.5
    np.testing.assert_allclose(drawn.springback.rotation, np.eye(3), atol=1e-9)  # a quarter cannot turn
    np.testing.assert_allclose(drawn.springback.shift[:2], 0.0, atol=1e-9)
    assert "major_middle" in drawn.result.frames[-1].cells


def test_friction_has_no_share_of_no_work():
    nothing = dict.fromkeys(("friction_work", "external_work"), np.zeros(1))
    with np.errstate(all="raise"):
        assert np.isnan(replace(cup(), result=nothing).friction_share)


def test_the_ripple_of_a_mesh_is_the_band_of_its_force(monkeypatch):
    drawn = replace(cup())
    own = float(drawn.forces["punch"].max()) / 1000.0
    force, ripple, band = drawn[FORCE].value, drawn.punch_force.ripple / 1000.0, drawn[FORCE].band
    assert band.error >= ripple and "ripple" in band.source and "studies" in band.source
    assert 0.0 < ripple < 0.2 * force and own == pytest.approx(force, abs=1.001 * ripple)
    assert drawn.punch_force_after is None and FORCE_OFF not in drawn.values
    monkeypatch.setattr(passage, "RIPPLE", 0.2)
    assert not any("ripples" in text for text in drawn.warnings)
    monkeypatch.setattr(passage, "RIPPLE", 0.01)
    assert f"the punch force, {force:.3g} kN, ripples by ± {ripple:.2g} kN as elements pass" in drawn.warnings[0]
    assert "--turn 31" in drawn.warnings[0]


def test_a_peak_off_the_holder_is_not_the_force_of_drawing():
    drawn = replace(cup())
    stroke = np.linspace(0.0, 40.0, 401)
    punch = 30e3 * np.sin(np.pi * stroke / 30.0).clip(0.0) + 50e3 * np.exp(-(((stroke - 33.0) / 1.5) ** 2))
    vars(drawn).update(
        stroke=stroke, forces={"punch": punch, "holder": np.where(stroke < 25.0, 20e3, 10.0), "die": punch}
    )
    rows = drawn.values
    assert rows["largest punch force"] == pytest.approx(30.0, rel=0.05)
    assert rows["at a stroke of"] == pytest.approx(15.0, abs=0.5)
    off, ripple = rows[FORCE_OFF], drawn.punch_force_after.ripple / 1000.0
    assert off + ripple >= 49.9 and rows["off the holder: at a stroke of"] == pytest.approx(33.0, abs=0.5)
    assert any("the rim is ironed row by row" in text for text in drawn.warnings)


def test_files_of_a_cup(tmp_path):
    files = {file.name for file in write_files(tmp_path, cup())}
    assert {"report.html", "ears.csv", "ears.png", "limits.png", "curve.csv", "draw.vtkhdf", "release.vtkhdf"} <= files
    assert "blank.png" in files
    with h5py.File(tmp_path / "release.vtkhdf") as file:
        assert "punch_distance" in file["VTKHDF/PointData"] and "limit_margin" in file["VTKHDF/CellData"]
    assert "punch_distance" in (tmp_path / "fields.csv").read_text().splitlines()[0]
    kept = json.loads((tmp_path / "part.json").read_text())
    assert kept["ending"] is None
    assert set(kept["balance"]) == {"drawing", "release"}
    assert set(kept["contacts"]["drawing"]) == {"on_die", "under_holder", "under_punch"}
    assert kept["contacts"]["release"] == {}  # they only open
    works = kept["balance"]["drawing"]["works"]
    assert works["punch"] > 0.0 and {"die", "holder"} < set(works)
    assert sum(works.values()) == pytest.approx(kept["balance"]["drawing"]["external_work"])
    page = (tmp_path / "report.html").read_text()
    assert "<td>work of punch</td>" in page and "<th>release</th>" in page
    assert "Forming limit diagram" in page and "Height of the cup" in page


def test_both_forming_limits_are_shaded_by_their_bands():
    """The band of the margin below the limit of strains; that of the use by paths, a part of the radius."""
    drawn = cup()
    left, right = limits(drawn).axes
    texts = [[text.get_text() for text in axes.get_legend().texts] for axes in (left, right)]
    assert all("its band" in names for names in texts)
    (shade,) = right.patches
    radius = np.hypot(*shade.get_xy().T)
    used = 0.01 * drawn[BY_PATHS].band.error
    assert radius.min() == pytest.approx(
        max(1.0 - used, 0.0) * min(drawn.paths.limit(np.radians(np.linspace(-44.0, 45.0, 200))))
    )
    plt.close("all")


def test_values_of_one_coarse_mesh_are_marked_everywhere(tmp_path):
    """Terminal, report and JSON take warnings, errors and rows from the same place."""
    drawn = cup()
    (said,) = [text for text in drawn.warnings if text.startswith("coarse mesh")]
    assert "turns 45 degrees over a radius, 15 is usual" in said
    assert not coarse(replace(CUP, turn=15.0)) and not coarse(replace(U, turn=12.0))
    header, *rows = drawn.tables["Measures"]
    counts = {"number of ears", "ears count from an amplitude of", "at a stroke of", "off the holder: at a stroke of"}
    alone = {row[0] for row in rows if not row[2].startswith("± ")}
    assert header[2] == "error" and alone == counts & {row[0] for row in rows}
    write_files(tmp_path, drawn)
    kept, page = json.loads((tmp_path / "part.json").read_text()), (tmp_path / "report.html").read_text()
    assert said in kept["warnings"] and kept["errors"]["largest thinning"] > 1.0
    thinning = next(one for one in kept["quantities"] if one["name"] == "largest thinning")["band"]
    assert {"mesh", "increments", "contact points", "penalty", "tolerance"} < set(thinning["sources"])
    assert "not from this run" in thinning["source"] and thinning["source"] in page
    assert "values of one mesh" in kept["about_errors"] and "values of one mesh" in page and said in page


def test_a_short_u_bend():
    drawn = draw(replace(U, stroke=8.0), frames=0, progress=False)
    assert drawn.ending is None and drawn.released is not None
    assert drawn.angles is None  # there is no wall yet
    assert any("the wall is too short" in text for text in drawn.warnings)
    assert drawn.forces["holder"][-1] == pytest.approx(2450.0, rel=1e-6)
    assert abs(drawn.released["punch_fz"][-1]) < 1e-9
    assert drawn.outline.draw_in[0] > 1.0


def test_a_wall_that_springs_back_far_is_measured_lower():
    """The wall curls to half of a circle of 20 mm: it is lower than the third height of the case."""
    case = replace(U, length=350.0, stroke=70.0)
    mesh = case.blank()
    s = np.clip(mesh.points[:, 0] - 25.0, 0.0, 20.0 * np.pi)
    flange = np.maximum(mesh.points[:, 0] - 25.0 - 20.0 * np.pi, 0.0)
    middle = np.column_stack(
        [np.minimum(mesh.points[:, 0], 25.0) + 20.0 * (1 - np.cos(s / 20.0)), 20.0 * np.sin(s / 20.0)]
    )
    u = np.zeros_like(mesh.points)
    u[:, 0], u[:, 2] = middle[:, 0] - mesh.points[:, 0], middle[:, 1] - flange
    model = SimpleNamespace(mesh=mesh, u=u.ravel())
    run = History(
        stroke=np.linspace(0.0, 70.0, 71), **{f"{tool}_fz": np.full(71, -50.0) for tool in ("punch", "holder", "die")}
    )
    run.model, run.warnings, run.frames = model, [], []
    drawn = Drawn(case, lambda minor: minor, run, u.ravel(), run, None)
    assert drawn.wall_heights == pytest.approx([17.0 * part / 55.0 for part in (15.0, 35.0, 55.0)], rel=0.02)
    assert drawn.angles is not None and drawn.angles.radius == pytest.approx(20.0, rel=0.05)
    assert drawn.punch_force.value == pytest.approx(case.parts * 50.0) and drawn.punch_force.ripple == 0.0
    assert any("sprung back below" in text for text in drawn.warnings)
    assert replace(drawn, released=None).angles is None


def test_a_steady_u_bend_is_drawn_in_equal_increments():
    case = U.steady()
    pace = case.problem().contents.steps[1].pace
    assert pace.first == pace.largest == 1.0 / 400.0
    assert pace.factor(Happened(iterations=40, turn=5.0, strain=0.1, contact=2.0)) > 1.0
    assert case.newton.residual <= 1e-6 < U.newton.residual
    assert case.steady() == case


@pytest.mark.long
def test_wall_and_curl_of_a_coarse_u_bend_are_reached_to_a_tenth_of_a_degree_in_three_more_runs():
    case = UBend(**NUMISHEET | UBend.meshes["coarse"], opening=53.0, material=dc04_like())
    want = {"theta1": uf.Wanted(98.5, 0.1), "radius of the wall": uf.Wanted(230.0, 1.6)}
    bounds = {"opening": (52.0, 55.0), "holder_force": (2000.0, 20000.0)}
    found = uf.compensate(case, want, list(bounds), bounds=bounds)
    assert found.reached
    assert len(found.trials) <= 4
    again = draw(found.subject, frames=0, progress=False)
    assert again["theta1"].value == pytest.approx(98.5, abs=0.1)


def test_a_holder_force_for_a_draw_in_is_found_in_two_more_runs():
    want = {"draw-in, mean": uf.Wanted(0.2, 0.001)}
    found = uf.compensate(replace(CUP, stroke=3.0), want, ["holder_force"], bounds={"holder_force": (5e3, 1e5)})
    assert found.reached
    assert len(found.trials) <= 3
    assert found.subject.holder_force > CUP.holder_force  # more force, less draw-in
    assert found.trials[0].results[0] > 0.21
    again = draw(found.subject, frames=0, progress=False)
    assert again["draw-in, mean"].value == pytest.approx(0.2, abs=0.001)


@pytest.mark.long
def test_a_u_bend_springs_back():
    drawn = draw(replace(U, length=350.0, stroke=70.0, turn=20.0), frames=0, progress=False)
    assert drawn.ending is None and drawn.angles is not None
    assert 92 < drawn.angles.theta1 < 105 and 70 < drawn.angles.theta2 < 88
    assert 100 < drawn.angles.radius < 400


def test_a_sheet_beyond_its_limit_is_named():
    drawn = draw(replace(CUP, stroke=4.0), limit=lambda minor: 0.0 * minor + 0.001, frames=0, progress=False)
    assert drawn.ending is not None and drawn.ending.kind == "torn" and not drawn.ending.early
    assert "beyond the forming limit" in drawn.warnings[0]


def test_the_stroke_at_the_forming_limit():
    drawn = cup()
    strains = [frame.cells["major_middle"].max() for frame in drawn.result.frames]
    strokes = np.interp([frame.time for frame in drawn.result.frames], drawn.result["time"], drawn.stroke)
    limit = 0.5 * (strains[-1] + strains[-2])
    for frame in drawn.result.frames:
        frame.cells["limit_margin"] = limit - frame.cells["major_middle"]
    ending = ending_of(CUP, drawn.result, lambda minor: 0.0 * minor + limit, None)
    middle = 0.5 * (strokes[-1] + strokes[-2])
    assert ending is not None and f"from a stroke of about {middle:.3g}" in ending.text
    assert drawn["stroke at the forming limit"].value == pytest.approx(middle)
    cup.cache_clear()


def test_only_ears_of_a_metal_with_directions_and_without_a_flange_count():
    metal = uf.Metal(70e3, 0.33, hardening=STEEL.hardening, yield_function=uf.Hill48(1.2, 0.8, 1.1))
    wide = {"die_radius": 39.8, "punch_radius": 38.0, "die_edge": 0.2}
    for changes, counted in (
        ({}, False),
        (wide, False),
        ({"material": metal}, False),
        (wide | {"material": metal}, True),
    ):
        drawn = replace(cup(), case=replace(CUP, **changes))
        assert drawn.has_ears is counted and ("number of ears" in drawn.values) is counted
        assert drawn.values.keys() <= set(names_of(drawn.case))


@pytest.mark.parametrize(
    ("force", "said"), [(20.0, ["kN in place of N"]), (20e3, []), (2e6, ["above the yield stress"])]
)
def test_a_holder_force_in_another_unit_is_a_warning(force, said):
    for case in (CUP, U):
        found = replace(case, holder_force=force * (1.0 if case is CUP else 0.5)).warnings
        assert len(found) == len(said) and all(part in text for part, text in zip(said, found, strict=True))


@pytest.mark.parametrize(("force", "friction", "kind"), [(500e3, 0.2, "torn"), (800e3, 0.5, "held")])
def test_a_holder_that_is_too_strong_tears_the_sheet(force, friction, kind):
    drawn = draw(replace(CUP, holder_force=force, stroke=25.0, friction=friction), frames=0, progress=False)
    assert drawn.ending is not None and drawn.ending.early and drawn.ending.kind == kind
    assert 5.0 < drawn.result["stroke"][-1] < 25.0 and drawn.released is None
    assert drawn.fields["limit_margin"].min() < 0.0


def test_a_loose_holder_lets_the_flange_wrinkle():
    drawn = draw(replace(CUP, holder_force=3e3, holder_gap=3.0, stroke=12.0), frames=0, progress=False)
    assert drawn.ending is not None and drawn.ending.kind == "wrinkled" and not drawn.ending.early
    assert "stands off both tools" in drawn.warnings[0] and drawn.ending.text.endswith("a stronger holder")
    fixed = replace(drawn.case, holder_force=None)
    folded, torn = (
        ending_of(fixed, drawn.result, drawn.limit, None),
        ending_of(fixed, cup().result, np.zeros_like, None),
    )
    assert folded.text.endswith("a smaller holder gap") and "; a larger holder gap, less friction" in torn.text


def test_wrinkles_lift_the_holder():
    """The part cannot be taken out, since its folds stand beyond the holder: what was reached is kept."""
    case = replace(CUP, holder_force=300.0, blank_radius=50.0, around=8, stroke=8.0)
    drawn = draw(case, limit=lambda minor: 0.0 * minor + 0.25, frames=10, progress=False)
    assert drawn.ending is not None and drawn.ending.kind == "wrinkled"
    assert "lifts the holder by" in drawn.ending.text and drawn.ending.text.endswith("a stronger holder")
    since = float(drawn.ending.text.split("a stroke of about ")[1].split(":")[0])
    assert 4.0 < since < 8.0


def test_no_element_turns_more_than_asked():
    for case in (CUP, replace(CUP, turn=10.0), U):
        for part in case.sizes.bent:
            assert case.sizes.largest_turn(part) < 1.15 * case.turn
    assert "degrees over the edge of the punch" in str(CUP.sizes)


def test_layers_by_rule_and_the_blank_before_the_run(tmp_path):
    """Two thickness points, so order 1, lock over a radius of 6; the complete order over one of 0.25."""
    assert CUP.needed_layers == U.needed_layers == 1 and before_the_run(U).endswith("; 1 layer")
    few = replace(CUP, thickness_points=2)
    assert (few.stacked, few.needed_layers) == (1, 2) and "--layers 2" in before_the_run(few)
    sharp = replace(CUP, layers=None, punch_edge=0.25)
    assert sharp.stacked == 2 and before_the_run(sharp).endswith("; 2 layers")
    assert len(sharp.blank().connectivity) == 2 * len(replace(sharp, layers=1).blank().connectivity)
    for case in (CUP, U):
        assert draw_blank(tmp_path, case)[0].read_bytes()[1:4] == b"PNG"


@dataclass(frozen=True, kw_only=True)
class OnFloor(Cup):
    """A cup whose bottom meets a floor below the die."""

    floor: float

    def build(self):
        model, press = super().build()
        floor = uf.Plane((0.0, 0.0, -self.floor - 0.5 * self.thickness), (0.0, 0.0, 1.0))
        model.contact("lower", floor, penalty=self.penalty, name="floor")
        return model, press


def test_a_punch_that_bottoms_is_named():
    case = OnFloor(**CUP.record() | {"stroke": 3.15}, floor=3.0)
    drawn = draw(case, limit=lambda minor: 0.0 * minor + 9.0, frames=0, progress=False)
    assert drawn.ending is not None and drawn.ending.kind == "bottomed"
    assert "the punch bottoms at a stroke of" in drawn.warnings[0]


@pytest.mark.parametrize(
    "wrong",
    [
        {"die_radius": 25.2},
        {"thickness": 1.6},
        {"die_radius": 52.8},
        {"punch_edge": 25.0},
        {"blank_radius": 20.0},
        {"holder_gap": 0.8},
        {"around": 5},
        {"friction": 9.0},
        {"thickness": -1.0},
        {"thickness": 0.001},
        {"material": uf.J2(E=206.0, nu=0.3, hardening=uf.Perfect(0.2))},
        {"material": uf.SVK(E=1.0, nu=0.3)},
    ],
)
def test_a_cup_that_cannot_be_drawn_is_refused(wrong):
    with pytest.raises(InvalidValue):
        replace(CUP, **wrong)


def test_a_blank_is_refused_up_to_the_diameter_that_the_remedy_names():
    with pytest.raises(InvalidValue, match="does not lie on the die") as refused:
        replace(CUP, blank_radius=CUP.throat)
    least = float(refused.value.remedy.split()[-1])
    replace(CUP, blank_radius=0.5 * least + 0.01)
    with pytest.raises(InvalidValue, match="does not lie on the die"):
        replace(CUP, blank_radius=0.5 * least - 0.01)


@pytest.mark.parametrize(
    "wrong", [{"opening": 50.1}, {"thickness": 1.2}, {"stroke": 90.0}, {"holder_force": None}, {"width": 0.0}]
)
def test_a_u_bend_that_cannot_be_drawn_is_refused(wrong):
    with pytest.raises(InvalidValue):
        replace(U, **wrong)


@pytest.mark.parametrize(("command", "kind", "usual"), [("cup", "Cup", 1.2), ("u", "UBend", 1.0 / 0.78)])
def test_the_default_opening_follows_the_thickness(monkeypatch, command, kind, usual):
    cases = []
    monkeypatch.setattr("umform.cli.draw._run", lambda case, *_, **__: cases.append(case))
    for more in ([], ["--thickness", "1.5"], ["--punch", "40", "--thickness", "2"]):
        assert CliRunner().invoke(app, ["draw", command, "--material", "DP600", *more]).exit_code == 0
    assert [type(case).__name__ for case in cases] == 3 * [kind]
    assert [case.clearance / case.thickness for case in cases] == pytest.approx(3 * [usual])
    assert cases[0].throat == (31.2 if kind == "Cup" else 52.0)
    refused = CliRunner().invoke(
        app, ["draw", command, "--material", "DP600", "--thickness", "1.5", "--opening", "62.4"]
    )
    assert (refused.exit_code != 0) == (kind == "Cup")  # 62.4 is a gap of 1.2 for the cup, 6.2 for the U


def test_a_clearance_below_the_thickness_is_a_warning():
    assert CUP.warnings == [] and U.warnings == []
    tight = replace(CUP, die_radius=25.95)
    assert "they iron the wall" in tight.warnings[0] and "52.4" in tight.warnings[0]
    drawn = replace(cup(), case=tight, released=None)
    assert any("they iron the wall" in text for text in drawn.warnings)


def test_a_holder_that_keeps_its_distance_from_a_coarse_mesh_is_a_warning():
    """A chord of 15 degrees of an edge of 6 mm rises by 0.051 mm; no study has such a holder."""
    held = replace(CUP, holder_force=None, turn=15.0, penalty=None)
    (said,) = replace(held, holder_gap=1.06).warnings
    assert "chords 0.051 off" in said and "--turn 11, a holder gap above 1.103" in said
    assert "turn" not in replace(held, holder_gap=1.0).warnings[0]
    for right in (
        replace(held, holder_gap=1.06, turn=11.0),
        replace(held, holder_gap=1.11),
        replace(held, holder_gap=1.06, element="BEND18"),
        replace(held, holder_gap=1.06, holder_force=20e3),
    ):
        assert right.warnings == []
    assert replace(cup(), case=held).studied is None


def test_a_part_that_stays_in_its_tools_has_no_springback():
    assert "largest springback" in cup().values
    kept = replace(cup(), released=None)
    assert "largest springback" not in kept.values and "gauge" not in pictures(kept)
    labels = [line.get_label() for line in sections(kept).axes[0].lines]
    assert "drawn" in labels and "released" not in labels
