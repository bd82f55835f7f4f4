"""Several bends in one part: equal to single bends where they are far apart, flanges, collisions, refusals."""

from __future__ import annotations

import json
import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from matplotlib import pyplot as plt

from umform.errors import FileProblem, InvalidValue
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.bend_sequence import Bend, BendSequence, Bodies, bend_sequence
from umform.processes.bend_sequence.collisions import Collision, collisions, die_body, punch_body
from umform.processes.bend_sequence.files import FILES, record, write_files
from umform.processes.bend_sequence.foreseen_collisions import foreseen_collisions, foreseen_text
from umform.processes.bend_sequence.form import read_sequence, sequence_form
from umform.processes.bend_sequence.page import curves
from umform.processes.bend_sequence.sides import Strip
from umform.processes.bend_sequence.spec import MOST_BENDS
from umform.processes.bend_sequence.strip import strip_lines

SHEET = AirBending(elements_per_thickness=1.0, layers=1, increment=0.0125)
STROKE = 5.0
AT = (30.0, 75.0)


@pytest.fixture(scope="module")
def single():
    return air_bending(replace(SHEET, stroke=STROKE), progress=False, frames=1).measures


@pytest.fixture(scope="module")
def told():
    return []


@pytest.fixture(scope="module")
def profile_z(told):
    bends = (Bend(AT[0], stroke=STROKE), Bend(AT[1], stroke=STROKE, direction="down"))
    return bend_sequence(BendSequence(110.0, bends, SHEET), frames=8, progress=lambda *tick: told.append(tick))


def test_one_bar_counts_the_bends(profile_z, told):
    assert [tick for tick in told if tick[0] == "all bends"] == [("all bends", 0.0), ("all bends", 0.5)]
    assert {name for name, *_ in told} >= {"bend 1, loading", "bend 2, loading"}


def test_tools_rub_a_part_as_they_rub_a_single_bend():
    """But for the elastic slip, whose stiffness follows from the given penalty here."""
    sheet = replace(SHEET, friction=0.2)
    part = bend_sequence(BendSequence(60.0, (Bend(30.0, stroke=3.0),), sheet), frames=1, progress=False)
    force = part.bends[0].measures.force
    rubbed, free = (air_bending(replace(sheet, stroke=3.0, friction=mu), progress=False) for mu in (0.2, 0.0))
    assert force == pytest.approx(rubbed.measures.force, rel=1e-3)
    assert force > 1.03 * free.measures.force


def test_bends_far_apart_are_single_bends(profile_z, single):
    for done in profile_z.bends:
        for name in ("angle", "loaded_angle", "springback"):
            assert getattr(done.measures, name) == pytest.approx(getattr(single, name), abs=1e-3)
        assert done.measures.force == pytest.approx(single.force, rel=1e-5)
        assert done.measures.bend_deduction == pytest.approx(single.bend_deduction, abs=1e-4)
        assert done.measures.outer_strain == pytest.approx(single.outer_strain, abs=1e-5)


def test_the_first_bend_outlives_the_second(profile_z):
    assert profile_z.angles == pytest.approx([done.measures.angle for done in profile_z.bends], abs=1e-3)


def test_flanges_and_deductions_of_single_bends_are_the_flat_length(profile_z, single):
    assert sum(profile_z.flanges) - 2.0 * single.bend_deduction == pytest.approx(110.0, abs=1e-3)
    half = 0.5 * single.bend_deduction
    assert profile_z.flanges == pytest.approx([AT[0] + half, AT[1] - AT[0] + 2.0 * half, 35.0 + half], abs=1e-2)
    assert profile_z.length_balance == pytest.approx(0.0, abs=1e-3)


def test_the_outer_legs_of_a_z_are_parallel(profile_z):
    middle = profile_z.strip.middle
    first, last = middle[4] - middle[0], middle[-1] - middle[-5]
    assert math.atan2(*first[::-1]) == pytest.approx(math.atan2(*last[::-1]), abs=2e-3)
    assert profile_z.warnings == []


def test_the_record_is_json(profile_z, tmp_path):
    text = json.loads(json.dumps(record(profile_z), allow_nan=False))
    assert text["flanges"] == pytest.approx(profile_z.flanges)
    assert text["bends"][1]["measures"]["angle"] == profile_z.bends[1].measures.angle
    assert len(text["profile"]) == len(profile_z.profile)
    assert text["bends"][0]["outline"]["before"]["stroke"] == 0.0
    first, second = (text["balance"][f"bend {number}"] for number in (1, 2))
    assert second["before"] == pytest.approx(first["external_work"], rel=0.01)
    assert max(one["force_imbalance"] for one in (first, second)) < 1e-6
    assert set(text["contacts"]["bend 2"]) == {"die", "punch"}
    write_files(tmp_path, profile_z)
    others = {f"bend{number}.toml" for number in range(3, MOST_BENDS + 1)}
    assert {file.name for file in tmp_path.iterdir()} == set(FILES) - others
    page = (tmp_path / "report.html").read_text()
    rows = [row for header, *rows in profile_z.tables.values() for row in rows]
    assert all(f"<td>{cell}</td>" in page for row in rows for cell in row[1:-1])
    assert [f"{length:.3f}" for length in profile_z.flanges] == [one.text for one in profile_z.of_part[:-1]]
    assert "coarse mesh" in page
    assert "bend 2, contact die: penetration up to" in page
    assert f"<td>work of punch</td><td>{first['works']['punch']:.6g}</td>" in page


def test_the_force_of_each_bend_is_shaded_by_its_band(profile_z):
    sequence = profile_z.sequence
    layered = replace(profile_z, sequence=replace(sequence, sheet=replace(sequence.sheet, layers=2)))
    figure = curves(layered)
    for number, (shade, done) in enumerate(zip(figure.axes[0].collections, layered.bends, strict=True), start=1):
        upper = shade.get_paths()[0].vertices[:, 1].max()
        band = layered[f"bend {number}: largest_force"].band
        assert upper == pytest.approx(done.force.max() + band.error, rel=1e-6)
    plt.close(figure)


def test_a_collision_is_told_in_plain_words(profile_z):
    hit = replace(profile_z.bends[0], collisions=(Collision("punch", 7.8, 0.0),))
    (said,) = replace(profile_z, bends=(hit, *profile_z.bends[1:])).warnings
    assert "bend 1: the part collides with the body of the punch from a stroke of 7.8 mm on, at 30 mm from" in said
    assert "invalid" in said


def test_collisions_are_foreseen_by_geometry():
    """The parts of docs/bending-operations.md: runs find none in U and Z, and one in the narrow U from 2 mm on."""

    def part(length, *bends):
        return BendSequence(length, tuple(Bend(at, 90.0, direction=way) for at, way in bends), SHEET)

    free = [part(120.0, (35.0, "up"), (85.0, "up")), part(110.0, (30.0, "up"), (75.0, "down"))]
    assert [foreseen_collisions(one) for one in free] == [{}, {}]
    narrow = part(145.0, (60.0, "up"), (85.0, "up"))
    ((hit,),) = foreseen_collisions(narrow).values()
    assert hit.tool == "punch" and 1.0 < hit.stroke < 3.5
    over = part(145.0, (60.0, "down"), (85.0, "down"))  # the same, seen from the other face
    ((same,),) = foreseen_collisions(over).values()
    assert same.stroke == pytest.approx(hit.stroke) and same.distance == pytest.approx(-hit.distance)
    assert "bend 2: by its geometry the part will collide" in foreseen_text(over, 2, same)
    assert foreseen_collisions(part(145.0, (60.0, "up"), (85.0, "down"))) == {}


def test_about_a_bend_line_the_mesh_is_that_of_a_single_bend():
    sequence = BendSequence(110.0, (Bend(75.0, 90.0), Bend(30.0, 90.0, tools={"opening": 12.0})), SHEET)
    lines = strip_lines(sequence)
    assert (np.diff(lines) > 0.0).all()
    assert (lines[0], lines[-1]) == (0.0, 110.0)
    for bend in sequence.bends:
        near = lines[np.abs(lines - bend.position) < sequence.zone(bend)] - bend.position
        assert near == pytest.approx(-near[::-1], abs=1e-9)
        assert 0.0 in near


def angle_section(position, lift):
    """A strip of 1 mm whose part beyond a position stands up, or hangs down."""
    x = np.linspace(-60.0, 60.0, 241)
    reference = np.stack([np.stack([x, np.full_like(x, z)], axis=1) for z in (0.0, 1.0)], axis=1)
    current = reference.copy()
    far = x > position
    current[far, :, 0] = position + reference[far, :, 1]
    current[far, :, 1] = lift * (x[far, None] - position)
    return Strip(reference, current, 1)


@pytest.mark.parametrize(
    ("position", "lift", "tools"),
    [(20.0, 1.0, []), (20.0, -1.0, ["die"]), (40.0, -1.0, []), (7.0, 1.0, ["punch"])],
)
def test_a_flange_in_a_body_is_found(position, lift, tools):
    case = AirBending(thickness=1.0, opening=8.0, stroke=1.0)
    found = collisions(case, 5.0, Bodies(die_width=40.0), [(0.0, angle_section(position, lift))])
    assert [hit.tool for hit in found] == tools
    assert all(hit.stroke == 0.0 and hit.distance > 5.0 for hit in found)


def test_bodies_are_closed_and_solid():
    for body in (die_body(SHEET, Bodies()), punch_body(SHEET, Bodies())):
        assert body.closed
        assert body.area > 0.0


@pytest.mark.parametrize(
    ("bends", "message"),
    [
        ([], "1 to 50 bends"),
        ([Bend(5.0, 90.0)], "too short for the die"),
        ([Bend(50.0, 90.0), Bend(60.0, 90.0)], "too short for the die"),
        ([Bend(50.0, 90.0), Bend(50.0, 90.0)], "bent once"),
        ([Bend(120.0, 90.0)], "beyond the strip"),
        ([Bend(50.0, 80.0)], "cannot be reached"),
    ],
)
def test_parts_that_cannot_be_bent_are_refused(bends, message):
    with pytest.raises(InvalidValue, match=message):
        BendSequence(100.0, tuple(bends), SHEET)


def test_bends_that_say_nothing_are_refused():
    with pytest.raises(InvalidValue, match="one of them"):
        Bend(20.0)
    with pytest.raises(InvalidValue, match="up or down"):
        Bend(20.0, 90.0, direction="left")
    with pytest.raises(InvalidValue, match="no size of the tools"):
        Bend(20.0, 90.0, tools={"width": 3.0})
    with pytest.raises(InvalidValue, match="plane strain"):
        BendSequence(100.0, (Bend(50.0, 90.0),), replace(SHEET, width=20.0))


def test_a_file_is_read(tmp_path):
    file = tmp_path / "part.toml"
    file.write_text("length = 90\n[[bends]]\nposition = 30\nangle = 90\ndirection = 'down'\nopening = 12\n")
    sequence = read_sequence(file).sequence(SHEET)
    assert sequence.bends == (Bend(30.0, 90.0, direction="down", tools={"opening": 12.0}),)
    assert sequence.case(sequence.bends[0]).opening == 12.0
    file.write_text("length = [")
    with pytest.raises(FileProblem, match="cannot be read"):
        read_sequence(file)
    file.write_bytes(b"\x9c")
    with pytest.raises(FileProblem, match="not UTF-8"):
        read_sequence(file)
    with pytest.raises(FileProblem, match="cause:  Is a directory"):
        read_sequence(tmp_path)
    file.write_text("[mesh]\nlength = 30.0\n[[steps]]\nkind = 'move'\n")
    with pytest.raises(FileProblem, match=r"a deck and no sequence of bends [\s\S]*remedy: umform run .*part.toml"):
        read_sequence(file)


@pytest.mark.parametrize(
    ("bend", "what", "cause"),
    [
        ({"position": 30, "angel": 90}, "this key is unknown here", "a typing error: did you mean angle?"),
        ({"positon": 30, "angle": 90}, "this key is unknown here", "a typing error: did you mean position?"),
        ({"angle": 90}, "the key position is missing", "it was left out"),
        ({"position": [1, 2], "angle": 90}, "position: it should be a valid number", "values that do not go together"),
    ],
)
def test_a_mistake_in_a_file_has_the_number_of_the_bend(bend, what, cause):
    with pytest.raises(InvalidValue, match=what) as refused:
        sequence_form({"length": 90, "bends": [{"position": 15, "angle": 90}, bend]}, "part.toml")
    assert refused.value.where == "part.toml, bend 2"
    assert cause in refused.value.cause


def test_a_sequence_is_pickled_for_another_process():
    sequence = BendSequence(60.0, (Bend(20.0, stroke=1.0, tools={"opening": 12.0}),), SHEET)
    assert pickle.loads(pickle.dumps(sequence)) == sequence
