"""Blanks corrected by runs of a deck: outlines met by rays, wanted edges, the flange of a cup."""

from __future__ import annotations

import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform import cli
from umform.errors import FileProblem
from umform.flat_pattern.net import net_blank
from umform.flat_pattern.net.corrections import _factor
from umform.flat_pattern.net.edge import Edge
from umform.flat_pattern.net.star import Star, stretched
from umform.flat_pattern.net.wanted import AtHeight, OnOutline, outline_of
from umform.problem import Problem, load
from umform.problem.templates import template
from umform.processes.draw import Cup
from umform.report.symmetry import Mirror
from umform.surfaces.dxf import write_dxf
from umform.surfaces.segments import Arc

HOLE = Arc((3.0, 0.0), (3.0, 0.0), (1.0, 0.0))
SQUARE = np.array([[2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]])


def deck() -> Problem:
    """A shallow cup of few elements, whose flange stays under the holder."""
    law = uf.sheet_metals.get("AA6016-T4").law
    sizes = {"blank_radius": 45.0, "punch_radius": 30.0, "punch_edge": 8.0, "die_edge": 8.0, "stroke": 12.0}
    return Cup(material=law, thickness=1.0, around=4, turn=45.0, holder_force=20e3, **sizes).problem()


def circle(radius: float, turn: float = 2.0 * np.pi) -> np.ndarray:
    angle = np.linspace(0.0, turn, 181)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


@pytest.mark.parametrize("order", [1, -1])
def test_rays_meet_the_sides_of_an_outline(order):
    star = Star.of(SQUARE[::order], (1.0, 1.0), "here")
    assert star.at(np.radians([0.0, 45.0, 90.0, -150.0, 225.0, 359.9999999999])) == pytest.approx(
        np.array([[2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [0.0, 1.0 - np.tan(np.pi / 6.0)], [0.0, 0.0], [2.0, 1.0]]),
        abs=1e-9,
    )


def test_rays_keep_the_height_of_an_outline():
    star = Star.of(np.c_[SQUARE, [0.0, 4.0, 4.0, 0.0]], (1.0, 1.0), "here")
    assert star.at([0.0]) == pytest.approx(np.array([[2.0, 1.0, 2.0]]))


def test_outlines_that_a_ray_meets_twice_are_refused():
    with pytest.raises(uf.errors.InvalidValue, match="more than once"):
        Star.of(SQUARE, (3.0, 1.0), "here")
    with pytest.raises(uf.errors.InvalidValue, match="three corners"):
        Star.of(SQUARE[:2], (1.0, 1.0), "here")


@pytest.mark.parametrize("ends", [(5.0, 90.0), (0.0, 85.0), (90.0, 180.0)])
def test_a_part_of_an_outline_reaches_over_the_whole_edge(tmp_path, ends):
    """Rays beyond its ends met the side that closes it: a blank of another shape, without a word."""
    arc = 40.0 * np.array([[np.cos(angle), np.sin(angle)] for angle in np.radians(np.linspace(*ends, 20))])
    for wrong in {"wanted": arc}, {"wanted": circle(40.0), "first": arc}:
        with pytest.raises(uf.errors.InvalidValue, match="does not reach over the whole modelled part"):
            net_blank(deck(), mesh=tmp_path / "net.inp", **wrong)
    Star.of(circle(40.0, np.pi), (0.0, 0.0), "here").check_reaches(np.linspace(0.0, np.pi, 9), "here")


def test_a_mesh_is_stretched_outside_of_its_inner_half():
    disc = uf.mesh.disc(20.0, 1.0, (4, 6), part="quarter")
    edge = Edge.of(disc, [Mirror(0, 0.0), Mirror(1, 0.0)])
    ellipse = Star.of(edge.star.points * [1.2, 0.9], edge.star.centre, "here")
    moved = stretched(disc, edge.star, ellipse)
    angle = np.arctan2(*disc.points[:, :2].T[::-1])
    inner = np.hypot(*disc.points[:, :2].T) < 0.5 * edge.star.radius(angle)
    assert inner.any()
    assert np.array_equal(moved.points[inner], disc.points[inner])
    rim = disc.nodes("rim")
    far = np.hypot(*moved.points[rim, :2].T)
    assert far == pytest.approx(ellipse.radius(np.arctan2(*disc.points[rim, :2].T[::-1])))
    assert abs(moved.points[disc.nodes("x0"), 0]).max() < 1e-12
    whole = edge.whole(ellipse)
    assert np.array_equal(whole[0], whole[-1])
    area = 0.5 * (whole[:-1, 0] * whole[1:, 1] - whole[1:, 0] * whole[:-1, 1]).sum()
    assert area == pytest.approx(1.2 * 0.9 * 0.5 * 20.0**2 * 32 * np.sin(2.0 * np.pi / 32))


def test_edges_of_blanks():
    assert len(Edge.of(uf.mesh.disc(20.0, 1.0, (4, 6)), []).ids) == 32
    half = Edge.of(uf.mesh.disc(20.0, 1.0, (4, 6), part="half"), [Mirror(0, 0.0)])
    assert half.star.points[[0, -1], 0] == pytest.approx([0.0, 0.0], abs=1e-12)
    with pytest.raises(uf.errors.InvalidValue, match="hole"):
        Edge.of(uf.mesh.ring(8.0, 20.0, 1.0, (4, 4)), [])
    with pytest.raises(uf.errors.InvalidValue, match="one layer"):
        Edge.of(uf.mesh.disc(20.0, 1.0, (4, 6), layers=2), [])


def test_wanted_places():
    edge = np.array([[10.0, 0.0, 7.0], [0.0, 11.0, 9.0]])
    flange = OnOutline(Star.of(circle(12.0), (0.0, 0.0), "here"))
    assert flange.places(edge, edge) == pytest.approx(np.array([[12.0, 0.0], [0.0, 12.0]]))
    assert flange.distance(edge, edge) == pytest.approx([2.0, 1.0], abs=2e-3)
    for turn in 0.5 * np.pi, np.pi:  # the side that closes a part is none of its own
        part = OnOutline(Star.of(circle(12.0, turn), (0.0, 0.0), "here"))
        inside = np.array([[11.0, 0.0, 0.0], [10.5, 0.5, 0.0], [0.0, 11.0, 0.0]])
        assert part.distance(inside, inside) == pytest.approx(flange.distance(inside, inside), abs=2e-3)
    surface = np.concatenate([edge, [[0.0, 0.0, -2.0]]])
    assert AtHeight(10.5).places(edge, surface)[:, 2].tolist() == [8.5, 8.5]
    assert AtHeight(10.5).distance(edge, surface).tolist() == [1.5, 0.5]
    assert AtHeight(10.5).distance(-edge, -surface).tolist() == [1.5, 0.5]


def test_the_factor_on_a_step():
    """It removes the error of a map that is linear, and has limits."""
    step = np.array([[1.0, 0.0], [0.0, 2.0]])
    assert _factor(1.0, [step]) == 1.0
    assert _factor(1.0, [step, -0.5 * step]) == pytest.approx(1.0 / 1.5)
    assert _factor(1.0, [step, 0.9 * step]) == 1.5
    assert _factor(1.0, [step, -3.0 * step]) == 0.5


def test_a_run_puts_the_flange_on_a_circle(tmp_path):
    """The modelled quarter of the wanted outline is enough; the ears of the metal are in the blank then."""
    found = net_blank(deck(), circle(40.0, 0.5 * np.pi), tmp_path / "net.inp", corrections=1)
    before, after = found.runs
    assert before.largest > 0.5
    assert after.largest < 0.12 * before.largest
    assert np.hypot(*found.outline.T).min() < 44.0
    assert found.deck.sheet().mesh.points == pytest.approx(found.deck.build().model.mesh.points)
    again = found.deck.build()
    again.solve(progress=False)
    assert found.edge.formed(again.model.mesh, again.model.u) == pytest.approx(after.formed, abs=1e-9)


def test_the_command(tmp_path):
    import ezdxf

    (tmp_path / "cup.toml").write_text(deck().toml(), encoding="utf-8")
    np.savetxt(tmp_path / "flange.csv", circle(40.0), delimiter=",", header="x,y", comments="")
    assert outline_of(tmp_path / "flange.csv") == pytest.approx(circle(40.0))
    words = ["net", str(tmp_path / "cup.toml"), "--outline", str(tmp_path / "flange.csv"), "--corrections", "1"]
    done = CliRunner().invoke(cli.app, words)
    assert done.exit_code == 0, done.output
    assert "correction 1" in done.output
    (outline,) = ezdxf.readfile(tmp_path / "cup-net.dxf").modelspace().query("LWPOLYLINE")
    assert outline.closed
    corrected = load(tmp_path / "cup-net.toml").sheet().mesh
    corners = np.array([p[:2] for p in outline.get_points()])
    rim = corrected.points[corrected.nodes("rim"), :2]
    assert (np.linalg.norm(rim[:, None] - corners, axis=2).min(axis=1) < 1e-9).all()
    assert outline_of(tmp_path / "cup-net.dxf") == pytest.approx(np.concatenate([corners, corners[:1]]))
    rows = np.genfromtxt(tmp_path / "cup-net.csv", delimiter=",", names=True)
    assert rows["distance"][rows["run"] == 1].max() < 0.12
    refused = CliRunner().invoke(cli.app, words[:2])
    assert refused.exit_code != 0
    assert "--outline" in str(refused.exception) + refused.output
    far = ["--height", "9", "--first", str(tmp_path / "far.csv")]
    np.savetxt(tmp_path / "far.csv", circle(1.0) + 100.0, delimiter=",")
    for wrong in (
        ["--height", "-3"],
        ["--height", "inf"],
        ["--height", "1e300"],
        ["--height", "9", "--corrections", "0"],
        far,
    ):
        refused = CliRunner().invoke(cli.app, [*words[:2], *wrong, "--overwrite"])
        assert refused.exit_code == 1 and f"where:  {wrong[-2]}" in refused.output
    refused = CliRunner().invoke(cli.app, [*words[:2], "--height", "9", "--first-layer", "0"])
    assert refused.exit_code == 1 and "a layer is that of a drawing" in str(refused.exception) + refused.output


def test_drawings_of_a_deck_in_inches_are_in_inches(tmp_path):
    """The numbers of the deck are taken as inches, the wanted outline is drawn in mm."""
    (tmp_path / "cup.toml").write_text(deck().with_({"units": {"length": "inch"}}).toml(), encoding="utf-8")
    radius = 40.0 * 25.4
    write_dxf(tmp_path / "flange.dxf", {"EDGE": [Arc((radius, 0.0), (radius, 0.0), (0.0, 0.0))]})
    words = ["net", str(tmp_path / "cup.toml"), "--outline", str(tmp_path / "flange.dxf"), "--corrections", "1"]
    done = CliRunner().invoke(cli.app, words)
    assert done.exit_code == 0, done.output
    assert "largest distance, in" in done.output
    rim = load(tmp_path / "cup-net.toml").sheet().mesh
    drawn = outline_of(tmp_path / "cup-net.dxf", unit="in")
    assert np.hypot(*drawn.T).max() == pytest.approx(np.hypot(*rim.points[:, :2].T).max(), rel=1e-9)
    assert outline_of(tmp_path / "cup-net.dxf") == pytest.approx(25.4 * drawn)


def test_a_row_of_an_outline_that_is_no_point_is_refused(tmp_path):
    path = tmp_path / "flange.csv"
    path.write_text("x,y\n40,0\n0,40 mm\n-40,0\n0,-40\n")
    with pytest.raises(FileProblem, match="a row of the outline is no point") as error:
        outline_of(path)
    assert error.value.where.endswith("row 3")
    path.write_text("40,\n0,40\n-40,0\n0,-40\n")  # not a heading
    with pytest.raises(FileProblem, match="a row of the outline is no point") as error:
        outline_of(path)
    assert error.value.where.endswith("row 1")


@pytest.mark.parametrize("rows", ["", "x;y\n40;0\n0;40\n-40;0\n", "40,0,0,1\n0,40,0,1\n-40,0,0,1\n"])
def test_a_table_that_is_no_outline_is_refused(tmp_path, rows):
    path = tmp_path / "flange.csv"
    path.write_text(rows)
    with pytest.raises(FileProblem, match="columns between commas"):
        outline_of(path)


def test_an_outline_on_a_layer_of_a_drawing(tmp_path):
    path = write_dxf(tmp_path / "flange.dxf", {"EDGE": [Arc((9.0, 0.0), (9.0, 0.0), (0.0, 0.0))], "HOLES": [HOLE]})
    assert np.hypot(*outline_of(path, "edge").T) == pytest.approx(9.0, abs=0.01)
    with pytest.raises(uf.errors.OpenSection, match="2 closed curves"):
        outline_of(path)
    with pytest.raises(uf.errors.InvalidValue, match="only a drawing has layers"):
        outline_of(tmp_path / "flange.csv", "EDGE")


@pytest.mark.parametrize(("start", "end"), [((9.0, 0.0), (0.0, 9.0)), ((0.0, -9.0), (0.0, 9.0))])
def test_an_outline_of_the_modelled_part(tmp_path, start, end):
    """Half of it has its ends above each other: there is no solid below."""
    path = write_dxf(tmp_path / "flange.dxf", {"EDGE": [Arc(start, end, (0.0, 0.0))]})
    corners = outline_of(path)
    assert np.hypot(*corners.T) == pytest.approx(9.0, abs=0.01)
    np.testing.assert_allclose([corners[0], corners[-1]], [start, end], atol=1e-12)


def test_an_outline_to_which_no_mesh_is_stretched_is_refused():
    disc = uf.mesh.disc(20.0, 1.0, (4, 6), part="quarter")
    edge = Edge.of(disc, [Mirror(0, 0.0), Mirror(1, 0.0)]).star
    with pytest.raises(uf.errors.InvalidValue, match=r"value:  0\.3 to 0\.3 of its distance"):
        stretched(disc, edge, Star.of(0.3 * edge.points, edge.centre, "here"))


def test_a_search_that_fails_leaves_no_mesh(tmp_path):
    with pytest.raises(uf.errors.InvalidValue, match="far from the formed sheet"):
        net_blank(deck(), 5000.0, tmp_path / "net.inp", corrections=1, first=circle(44.0))
    assert not list(tmp_path.iterdir())


def test_a_deck_that_does_not_begin_with_its_blank_is_refused(tmp_path):
    """Before its run: the blank is that of another deck, or lies elsewhere."""
    placed = deck().with_({"placement": {"rotation": np.eye(3).tolist(), "shift": [0.0, 0.0, 1.0]}})
    with pytest.raises(uf.errors.InvalidValue, match="is no flat blank"):
        net_blank(placed, 20.0, tmp_path / "net.inp")


def test_a_first_blank_is_given(tmp_path):
    found = net_blank(deck(), circle(40.0), tmp_path / "net.inp", corrections=1, first=circle(44.0))
    assert found.runs[0].blank.radius([0.0, 0.3]) == pytest.approx([44.0, 44.0], rel=0.02)
    assert found.best.largest < 0.12


def test_a_square_cup_of_a_deck(tmp_path):
    """Its flange must end on a rounded square; the blank was a square that is much too large."""
    places = [0.0, 12.5, 25.0, 31.0, 37.0, 43.0, 52.0, 57.75, 63.5, 69.25, 75.0]
    steps = {"element.name": "ANS3DEAS", "steps.1.to.stroke": 10.0, "mesh.x": places, "mesh.y": places}
    square = Problem.read(template("square-cup"), changes=steps)
    turn = np.linspace(0.0, 0.5 * np.pi, 13)
    corner = 36.0 + 30.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    found = net_blank(square, [[66.0, 0.0], *corner, [0.0, 66.0]], tmp_path / "net.inp")
    first, one, two = (run.largest for run in found.runs)
    assert first > 15.0
    assert one < 0.4
    assert two < 0.05
    assert found.outline[:-1].sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("wrong", [{"wanted": -3.0}, {"corrections": 0}, {"wanted": circle(1.0) + 100.0}])
def test_what_cannot_be_wanted_is_refused(tmp_path, wrong):
    with pytest.raises(uf.errors.InvalidValue):
        net_blank(deck(), **{"wanted": 20.0, "mesh": tmp_path / "net.inp"} | wrong)
