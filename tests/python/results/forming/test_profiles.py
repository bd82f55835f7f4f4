"""Ears, draw-in, sections, angles of a U-bend, gauges."""

import numpy as np
import pytest
from scipy.signal import find_peaks

import umform as uf
from umform.errors import InvalidValue
from umform.results.forming import (
    EarProfile,
    distance_from,
    draw_in,
    ear_profile,
    lay_by_best_fit,
    lay_on_three_points,
    section,
    u_bend_angles,
)


def _cup(part):
    """A cup with four ears of 2 mm about a mean height of 20 mm."""
    blank = uf.mesh.disc(10.0, 1.0, (8, 3), part=part)
    r, angle = np.hypot(*blank.points[:, :2].T), np.arctan2(blank.points[:, 1], blank.points[:, 0])
    height = np.where(r > 9.999, 20.0 + np.cos(4 * angle), 0.0)
    u = np.zeros_like(blank.points)
    u[:, 2] = np.where(r > 9.999, height - blank.points[:, 2], -blank.points[:, 2])
    return blank, u


@pytest.mark.parametrize("part", ["quarter", "half", "whole"])
def test_ears(part):
    ears = ear_profile(*_cup(part))
    assert ears.mean == pytest.approx(20.0, abs=0.02)
    assert ears.amplitude == pytest.approx(2.0, abs=1e-9)
    np.testing.assert_allclose(ears.ears(), [0, 90, 180, 270], atol=0.5)
    np.testing.assert_allclose(ears.valleys(), [45, 135, 225, 315], atol=0.5)
    np.testing.assert_allclose(ears.at(np.array([0.0, 135.0, 270.0])), [21, 19, 21], atol=1e-6)


def test_waves_of_single_elements_are_no_ears():
    blank, u = _cup("quarter")
    rim = np.hypot(*blank.points[:, :2].T) > 9.999
    angle = np.degrees(np.arctan2(blank.points[:, 1], blank.points[:, 0]))
    u[rim, 2] += 0.4 * (-1.0) ** np.round(angle[rim] / 11.25)
    np.testing.assert_allclose(ear_profile(blank, u).ears(), [0, 90, 180, 270], atol=0.5)


def test_a_fine_rim_has_room_for_eight_ears():
    angle = np.linspace(0.0, 90.0, 13)
    profile = EarProfile(angle, 20.0 + np.cos(np.radians(8.0 * angle)))
    np.testing.assert_allclose(profile.ears(), np.arange(0.0, 360.0, 45.0), atol=0.5)


def test_a_round_rim_has_no_ears():
    assert len(EarProfile(np.linspace(0.0, 90.0, 9), np.full(9, 20.0)).ears()) == 0


def test_ears_of_a_cup_that_opens_downwards():
    blank, u = _cup("quarter")
    u[:, 2] = -2 * blank.points[:, 2] - u[:, 2]
    assert ear_profile(blank, u).mean == pytest.approx(20.0, abs=0.02)


def test_equally_high_nodes_of_one_ear_are_one_ear():
    """Mirror images beside 0 and 90 degrees that are higher than the node between them by a trace."""
    angle = np.linspace(0.0, 90.0, 9)
    height = 35.0 + 0.9 * np.cos(np.radians(4 * angle))
    height[[1, -2]] = height[0] + 4e-4
    ears = EarProfile(angle, height)
    np.testing.assert_allclose(ears.ears(), [0, 90, 180, 270], atol=1e-6)
    np.testing.assert_allclose(ears.valleys(), [45, 135, 225, 315], atol=1e-6)


def _wavy(waves, nodes=49, until=90.0):
    """A rim at 35 mm with waves: by their number the amplitude, or the amplitude and the angle of its crest."""
    angle = np.linspace(0.0, until, nodes)
    height = np.full(nodes, 35.0)
    for number, wave in waves.items():
        amplitude, crest = wave if isinstance(wave, tuple) else (wave, 0.0)
        height += amplitude * np.cos(np.radians(number * (angle - crest)))
    return EarProfile(angle, height)


RIPPLES = {8: -0.05, 12: 0.06, 16: 0.04, 20: 0.05}


@pytest.mark.parametrize(
    ("waves", "ears"),
    [
        ({4: 0.6} | RIPPLES, [0, 90, 180, 270]),
        ({4: -0.6} | RIPPLES, [45, 135, 225, 315]),
        ({4: 0.1} | RIPPLES, []),
        ({}, []),
        ({4: 0.17}, []),
        ({4: 0.18}, [0, 90, 180, 270]),
        ({8: 0.3, 4: 0.05}, [0, 45, 90, 135, 180, 225, 270, 315]),
        ({6: 0.5, 4: 0.1}, [0, 60, 120, 180, 240, 300]),
        ({2: 0.5} | RIPPLES, [0, 180]),
        ({4: 0.6, 2: 0.3}, [0, 90, 180, 270]),
        ({4: 0.6, 8: -0.6}, [18.9, 71.1, 108.9, 161.1, 198.9, 251.1, 288.9, 341.1]),
    ],
)
def test_ears_are_waves_above_a_threshold(waves, ears):
    profile = _wavy(waves)
    np.testing.assert_allclose(profile.ears(), ears, atol=0.6)
    assert profile.smallest_ear == pytest.approx(0.005 * 35.0, rel=2e-3)
    numbers = profile.waves()
    for number in (2, 4, 6, 8):
        assert numbers[f"amplitude of {number} waves"] == pytest.approx(abs(waves.get(number, 0.0)), abs=1e-9)


def test_ears_are_the_prominent_peaks_of_their_waves():
    random, angle = np.random.default_rng(2), np.radians(0.5 * np.arange(720))
    for _ in range(20):
        waves = {
            n: (random.uniform(0.2, 1.0), random.uniform(0.0, 360.0 / n)) for n in random.choice(np.arange(2, 9), 3)
        }
        profile = _wavy(waves, nodes=97, until=360.0)
        height = sum(size * np.cos(n * (angle - np.radians(crest))) for n, (size, crest) in waves.items())
        for sign, found in ((1.0, profile.ears()), (-1.0, profile.valleys())):
            peaks, _ = find_peaks(np.tile(sign * height, 3), prominence=2.0 * profile.smallest_ear)
            np.testing.assert_allclose(found, 0.5 * (peaks[(peaks >= 720) & (peaks < 1440)] - 720), atol=0.6)


def test_ears_between_the_axes_of_a_whole_cup():
    whole = _wavy({4: (0.5, 17.0), 1: 1.0, 3: 0.1}, nodes=97, until=360.0)
    np.testing.assert_allclose(whole.ears(), [17, 107, 197, 287], atol=0.6)
    assert whole.wave(4) == pytest.approx((0.5, 17.0), abs=0.02)
    assert "4 ears, amplitude 0.5" in whole.words("mm")
    assert _wavy({4: 0.1}).words("mm") == "no ears above 0.175 mm"


def test_a_rim_of_few_elements_resolves_few_waves():
    """What its nodes stand off the waves that they resolve raises the smallest ear."""
    angle = np.linspace(0.0, 90.0, 9)
    rough = EarProfile(angle, 35.0 + 0.4 * np.cos(np.radians(4 * angle)) + 0.5 * (-1.0) ** np.arange(9))
    assert rough.resolved == 5 and "amplitude of 6 waves" not in rough.waves()
    assert rough.smallest_ear == pytest.approx(0.5 * np.sqrt(2.0), rel=1e-6) and len(rough.ears()) == 0
    with pytest.raises(InvalidValue, match="resolves 5 waves"):
        rough.wave(6)


@pytest.mark.parametrize("part", ["quarter", "whole"])
def test_the_mean_draw_in_is_that_along_the_edge_not_of_its_nodes(part):
    """Two waves around the rim have the mean zero; the ends of a quarter belong to one side each."""
    blank = uf.mesh.disc(10.0, 1.0, (8, 3), part=part)
    angle = np.arctan2(blank.points[:, 1], blank.points[:, 0])
    edge = draw_in(blank, -blank.points * (0.1 + 0.05 * np.cos(4.0 * angle))[:, None] * (1.0, 1.0, 0.0))
    assert edge.mean() == edge.mean(edge.pieces[0]) == pytest.approx(1.0, abs=1e-3)
    assert edge.lengths.sum() == pytest.approx({"quarter": 5.0, "whole": 20.0}[part] * np.pi, rel=2e-3)


def test_the_mean_draw_in_does_not_follow_a_finer_mesh_of_a_part_of_the_edge():
    y = np.concatenate([np.linspace(0.0, 2.0, 11), [6.0, 10.0]])
    grid = uf.mesh.grid(np.linspace(0.0, 10.0, 3), y, np.array([0.0, 1.0]))
    edge = draw_in(grid, -0.1 * grid.points[:, [1, 0, 2]] * (1.0, 0.0, 0.0), "x1")
    assert edge.mean() == pytest.approx(0.5, rel=1e-12)


def test_draw_in():
    blank = uf.mesh.disc(10.0, 1.0, (4, 3), part="quarter")
    edge = draw_in(blank, -0.1 * blank.points)
    np.testing.assert_allclose(edge.draw_in, 1.0, rtol=1e-12)  # also in the planes of symmetry
    assert (np.diff(np.arctan2(edge.before[:, 1], edge.before[:, 0])) > 0).all()


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_draw_in_of_two_edges_that_face_each_other(cell):
    strip = uf.mesh.strip(20.0, 1.0, 0.5, (10, 1), cell=cell)
    u = np.zeros_like(strip.points)
    u[:, 0] = np.where(strip.points[:, 0] < 10.0, 3.0, -5.0)
    edge = draw_in(strip, u, np.union1d(strip.nodes("x0"), strip.nodes("x1")))
    assert [len(piece) for piece in edge.pieces] == ([2, 2] if cell == "hex8" else [3, 3])
    assert not edge.is_closed
    np.testing.assert_allclose(edge.draw_in, np.where(edge.before[:, 0] < 10.0, 3.0, 5.0), rtol=1e-12)


@pytest.mark.parametrize("layers", [1, 2])
def test_draw_in_of_an_edge_with_a_corner_inwards(layers):
    x = np.linspace(0.0, 10.0, 11)
    whole = uf.mesh.grid(x, x, np.linspace(0.0, 1.0, layers + 1))
    middle = whole.points[whole.connectivity].mean(axis=1)
    cells = whole.connectivity[(middle[:, 0] < 3.0) | (middle[:, 1] < 3.0)]
    used, numbered = np.unique(cells, return_inverse=True)
    part = uf.Mesh(whole.points[used], {"hex8": numbered.reshape(cells.shape)})
    rim = np.array([[0, 0], [10, 0], [10, 3], [3, 3], [3, 10], [0, 10]])
    p, q = rim[:, None], np.roll(rim, -1, axis=0)[:, None]
    share = np.clip(((part.points[:, :2] - p) * (q - p)).sum(axis=2) / ((q - p) ** 2).sum(axis=2), 0.0, 1.0)
    on_rim = (np.linalg.norm(part.points[:, :2] - p - share[..., None] * (q - p), axis=2) < 1e-9).any(axis=0)
    edge = draw_in(part, np.tile([-1.0, 0.0, 0.0], (len(part.points), 1)), np.flatnonzero(on_rim))
    assert edge.is_closed and len(edge.draw_in) == 40
    (x, y), corner = edge.before.T, (edge.before[:, None] == rim).all(axis=2).any(axis=1)
    right = np.isin(x, [3.0, 10.0]) & ((x == 10.0) | (y > 3.0))
    expected = np.where(x == 0.0, -1.0, np.where(right, 1.0, 0.0))
    np.testing.assert_allclose(edge.draw_in[~corner], expected[~corner], atol=1e-12)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize(("y", "gaps"), [(0.0, 1), (5.0, 1), (12.0, 0)])
def test_section_through_a_hole(cell, y, gaps):
    washer = uf.mesh.ring(inner=10.0, outer=50.0, thickness=1.0, cells=(24, 8), cell=cell)
    cut = section(washer, np.zeros_like(washer.points), point=(0.0, y, 0.0))
    assert cut.gaps.sum() == gaps
    chord = 2.0 * (np.sqrt(50.0**2 - y**2) - (np.sqrt(10.0**2 - y**2) if gaps else 0.0))
    assert cut.length == pytest.approx(chord, rel=5e-3)


@pytest.mark.parametrize("nodes", ["centre", "lower"])
def test_nodes_that_are_no_edge_are_refused(nodes):
    blank = uf.mesh.disc(10.0, 1.0, (4, 3))
    with pytest.raises(InvalidValue, match="nodes are no edge of the sheet"):
        draw_in(blank, np.zeros_like(blank.points), nodes)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("layers", [1, 2])
def test_section(cell, layers):
    strip = uf.mesh.strip(6.0, 2.0, 0.5, (6, 3), cell=cell, layers=layers)
    u = np.zeros_like(strip.points)
    u[:, 2] = 0.1 * strip.points[:, 0]
    cut = section(strip, u, point=(0.0, 0.9, 0.0))
    np.testing.assert_allclose(cut.s[[0, -1]], [0.0, 6.0])
    np.testing.assert_allclose(cut.middle, np.column_stack([cut.s, np.full(len(cut.s), 0.9), 0.1 * cut.s]), atol=1e-12)
    np.testing.assert_allclose(cut.upper[:, 2] - cut.lower[:, 2], 0.5)
    with pytest.raises(InvalidValue, match="does not cut"):
        section(strip, u, point=(0.0, 5.0, 0.0))


def test_u_bend_without_springback_and_with_a_round_wall():
    s = np.linspace(0, 1, 101)[1:]
    bottom, wall, flange = (
        np.column_stack([25 * s, 0 * s]),
        np.column_stack([25 + 0 * s, 70 * s]),
        np.column_stack([25 + 60 * s, 70 + 0 * s]),
    )
    line = np.concatenate([[[0.0, 0.0]], bottom, wall, flange])
    found = u_bend_angles(line)
    assert found.theta1 == pytest.approx(90) and found.theta2 == pytest.approx(90) and found.radius > 1e6
    narrow = np.concatenate([[[0.0, 0.0]], bottom * [0.4, 1.0], wall - [15.0, 0.0], flange - [15.0, 0.0]])
    assert u_bend_angles(narrow).theta1 == pytest.approx(90)  # its wall stands at 10 mm, the lowest height is 15
    assert u_bend_angles(narrow, flat=5.0).theta1 == pytest.approx(90)
    inward = [[[0.0, 0.0]], bottom[::20], wall[::20], flange * [-1.0, 1.0] + [50.0, 0.0]]
    assert u_bend_angles(np.concatenate(inward)).theta1 == pytest.approx(90)  # ends beyond the middle of the bottom
    R = 200.0
    wall = np.column_stack([25 + R - R * np.cos(70 * s / R), R * np.sin(70 * s / R)])
    assert u_bend_angles(np.concatenate([[[0.0, 0.0]], bottom, wall])).radius == pytest.approx(R, rel=1e-3)
    with pytest.raises(InvalidValue, match="does not reach"):
        u_bend_angles(line, heights=(15, 35, 80))


def test_a_part_in_its_gauge():
    rng = np.random.default_rng(3)
    gauge = rng.normal(size=(20, 3))
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    part = gauge @ turn.T + [1.0, 2.0, 3.0]
    for laid in (lay_by_best_fit(part, gauge), lay_on_three_points(part, gauge, (0, 5, 9))):
        np.testing.assert_allclose(laid.points, gauge, atol=1e-12)
        assert np.linalg.det(laid.rotation) == pytest.approx(1.0)
    part[7] += [0.3, 0.0, 0.0]
    fitted = lay_by_best_fit(part, gauge)
    assert (fitted.distance**2).sum() < (lay_on_three_points(part, gauge, (0, 5, 9)).distance ** 2).sum()
    assert lay_on_three_points(part, gauge, (0, 5, 9)).largest == pytest.approx(0.3)
    with pytest.raises(InvalidValue):
        lay_on_three_points(part, gauge, (0, 0, 9))


def test_distance_from_a_tool_where_it_stands():
    strip = uf.mesh.strip(6.0, 2.0, 0.5, (6, 1))
    model = uf.Model(strip, material=uf.SVK(E=1.0, nu=0.3))
    ball = model.tool("ball", uf.Sphere((0.0, 0.0, 5.0), 2.0))
    way = model.drive(ball, "z")
    way.value = 1.0
    assert distance_from(ball, np.array([[0.0, 0.0, 0.0]]))[0] == pytest.approx(4.0)
