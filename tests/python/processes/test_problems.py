"""The problem of each process: it is written, read and run with the history of the process, to the last bit."""

from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.problem import DeckError, Problem, load, running
from umform.problem.templates import template_file, templates
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.bend_sequence import bend_sequence
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.processes.bending.case import free_bending
from umform.processes.bending.spec import FreeBending
from umform.processes.draw.case import draw
from umform.processes.draw.cup import ESAFORM, Cup
from umform.processes.draw.u_bend import NUMISHEET, UBend
from umform.processes.draw_bead.case import drawn_through
from umform.processes.draw_bead.spec import DrawBead
from umform.processes.hemming import Hemming, hemming
from umform.processes.hemming.spec import acute
from umform.processes.problems import outcome_of, problem_of, quantities_named

METAL = uf.sheet_metals.get("DC04").law
CUP = Cup(**ESAFORM | Cup.meshes["coarse"] | {"stroke": 2.0}, material=METAL)
U = UBend(**NUMISHEET | UBend.meshes["coarse"] | {"stroke": 8.0}, material=METAL)
BEND = AirBending(stroke=1.0, layers=1, elements_per_thickness=1.0)


@pytest.mark.parametrize("case", [CUP, replace(CUP, holder_force=None), U], ids=["cup", "cup-fixed", "u"])
def test_the_deck_of_a_drawn_part_repeats_its_history(case):
    drawn = draw(case, frames=1, progress=False)
    again = Problem.read(problem_of(case).toml()).build().solve(progress=False)
    held = len(drawn.result["time"])
    for name in ("stroke", "punch_fz", "holder_fz", "on_die_penetration"):
        assert drawn.result[name].tolist() == again[name][:held].tolist(), name
    assert drawn.released is not None
    assert drawn.released.model.u.tolist() == again.model.u.tolist()
    repeated = outcome_of(case, again).values
    assert repeated.keys() <= set(quantities_named(case))
    of_frames = "forming limit used, by paths"  # strain paths are those of the frames that are kept
    assert repeated.pop(of_frames) == pytest.approx(drawn.values[of_frames], abs=0.05)
    assert repeated == {name: value for name, value in drawn.values.items() if name != of_frames}
    for first, last in ((1, 2), (3, 3)):  # the part of a history has its pictures at its own rows
        part = again.of_steps(first, last)
        assert part.rows[-1]["step"] == last and part.frames
        assert [frame.time for frame in part.frames] == [part.rows[frame.number]["time"] for frame in part.frames]


def test_the_outcome_of_a_bend_is_that_of_the_process():
    case = replace(BEND, stroke=6.5)
    done = air_bending(case, progress=False)
    assert done["largest_force"].value > 1.05 * done["force"].value
    assert outcome_of(case, problem_of(case).build().solve(progress=False)).values == done.values
    assert list(done.values) == quantities_named(case)


def test_the_deck_of_a_bead_repeats_its_history():
    case = DrawBead(radius=4.0, height=2.0, elements=2.0, element="BEND8", material=METAL)
    drawn = drawn_through(case, frames=0, progress=False)
    again = Problem.read(problem_of(case).toml()).build().solve(progress=False)
    assert drawn.result.table().keys() == again.table().keys()
    assert all(column.tolist() == again[name].tolist() for name, column in drawn.result.table().items())
    assert outcome_of(case, again).values == drawn.values
    assert drawn.values.keys() == quantities_named(case).keys()


def repeated(decks, folder, monkeypatch):
    """Results of decks that are run one after the other."""
    monkeypatch.chdir(folder)
    for name, text in decks.items():
        (folder / name).write_text(text)
    for name in decks:
        deck = load(name, {f"output.{file}": False for file in ("csv", "vtkhdf", "report", "pictures")})
        yield running.run(deck, running.prepared(deck, "auto"), progress=False).result


def test_the_decks_of_bends_and_a_hem_repeat_their_histories(tmp_path, monkeypatch):
    sheet = acute(layers=1, elements_per_thickness=1.0, increment=0.025)
    hem = hemming(Hemming(form="insert", base=13.0, sheet=sheet, increments=12), frames=1, progress=False)
    runs = [hem.first.bends[0].result, hem.result]
    for run, again in zip(runs, repeated(hem.decks(), tmp_path, monkeypatch), strict=True):
        assert run.table().keys() == again.table().keys()
        assert all(column.tolist() == again[name].tolist() for name, column in run.table().items())


def test_the_deck_of_a_bend_that_is_turned_over_repeats_its_history(tmp_path, monkeypatch):
    sheet = AirBending(thickness=1.0, opening=8.0, die_radius=1.0, layers=1, elements_per_thickness=1.0)
    bends = Bend(20.0, stroke=1.0), Bend(40.0, stroke=1.0, direction="down")
    part = bend_sequence(BendSequence(60.0, bends, sheet), frames=1, progress=False)
    assert list(part.decks()) == ["bend1.toml", "bend2.toml"]
    for done, again in zip(part.bends, repeated(part.decks(), tmp_path, monkeypatch), strict=True):
        assert done.result["stroke_force"].tolist() == again["stroke_force"].tolist()
        assert done.result.model.u.tolist() == again.model.u.tolist()
    with pytest.raises(InvalidValue, match="a deck names the files of the operation before"):
        part.bends[1].problem.toml()


def test_free_bending_reports_of_a_run_of_its_problem():
    case = FreeBending(mesh=(8, 1), steps=8, stroke=3.0, unload=False)
    found = uf.derivatives(case, ["mu"], progress=False)
    done = free_bending(case, progress=False)
    assert [one.value for one in found.responses] == [one.value for one in done.quantities if one.value is not None]


@pytest.mark.parametrize("case", [Hemming(), METAL], ids=["hem", "law"])
def test_what_has_no_problem_of_its_own_is_refused(case):
    with pytest.raises(InvalidValue, match=r"(?s)no case of a process with one problem.*several operations"):
        problem_of(case)


def test_a_path_changes_a_number_and_the_mesh_follows():
    problem = problem_of(BEND)
    numbers = {one.path: one for one in problem.paths()}
    assert numbers["tools.die.shoulder_radius"].value == BEND.die_radius
    assert numbers["material.hardening.exponent"].value == BEND.material.hardening.exponent
    assert numbers["steps.0.cuts"].sentence == "How often an increment may be halved before the run fails."
    assert not [path for path in numbers if path.startswith("output.")]
    changed = problem.with_({"tools.die.shoulder_radius": 2.1, "steps.0.to.stroke": 0.4}, same_topology=True)
    assert changed.contents.tools["die"].tool.shoulder_radius == 2.1
    assert "stroke = 0.4" in changed.toml() and "stroke = 0.4" not in problem.toml()
    strip = Problem.read(template_file("cantilever").read_text())
    longer = strip.with_({"mesh.length": 11.0}, same_topology=True)
    assert np.ptp(longer.sheet().mesh.points[:, 0]) == 11.0
    with pytest.raises(InvalidValue, match="the mesh has another topology with this value") as refused:
        strip.with_({"mesh.cells.0": 3}, same_topology=True)
    assert refused.value.where == "mesh.cells.0"
    with pytest.raises(DeckError) as nowhere:
        strip.with_({"mesh.cells.7": 3})
    assert nowhere.value.errors[0].where == "mesh.cells.7"


@pytest.mark.parametrize("name", templates())
def test_each_path_of_a_template_can_be_changed(name):
    """Also entries of arrays that the deck leaves to their defaults, and the corners of profiles."""
    problem = load(template_file(name))
    paths = problem.paths()
    assert problem.with_({one.path: one.value for one in paths}).paths() == paths


def test_one_entry_of_an_array_that_the_deck_leaves_out():
    assert problem_of(BEND).with_({"tools.die.rotation.1": 5.0}).contents.tools["die"].rotation == (0.0, 5.0, 0.0)
    strip = load(template_file("cantilever"), {"mesh.shift.2": 3.0})
    assert strip.contents.mesh.shift == (0.0, 0.0, 3.0)
    with pytest.raises(DeckError):
        strip.with_({"mesh.shift.3": 3.0})


def test_the_corners_of_a_profile_are_paths_and_its_segments_are_not():
    numbers = {one.path: one.value for one in load(template_file("cup")).paths()}
    assert numbers["tools.die.profile.radii.1"] == 10.0
    assert not [path for path in numbers if path.startswith("tools.die.profile.segments")]


def test_numbers_of_numpy_are_written_as_those_of_python():
    changes = {"tools.die.opening": np.float64(16.25), "steps.0.increments": np.int64(7)}
    text = problem_of(BEND).with_(changes).toml()
    assert "opening = 16.25\n" in text and "increments = 7\n" in text
    assert load(template_file("cantilever"), {"mesh.cells": np.array([5, 1])}).contents.mesh.cells == (5, 1)


def test_changes_neither_reach_the_tables_they_came_from_nor_outlive_later_ones():
    strip = load(template_file("cantilever"))
    table = dict(strip.source.data["mesh"])
    given = strip.with_({"mesh": table})
    longer = given.with_({"mesh.length": 99.0})
    assert table["length"] == given.with_({"title": "again"}).contents.mesh.length == 10.0
    assert longer.contents.mesh.length == 99.0
    assert longer.with_({"mesh": table}).contents.mesh.length == 10.0


def test_a_path_to_a_thing_that_is_not_there_is_a_slip():
    with pytest.raises(DeckError) as refused:
        problem_of(BEND).with_({"tools.dye.opening": 1.0})
    (error,) = refused.value.errors
    assert (error.where, error.value) == ("tools.dye.opening", "dye")
    assert error.cause == "a typing error: did you mean die?"
    assert repr(problem_of(BEND)) == "Problem('Air bending', 3 steps)"


def test_a_path_into_a_metal_of_the_library_writes_its_law_out():
    text = '[mesh]\ngenerator="strip"\nlength=9.0\nwidth=1.0\nthickness=1.0\ncells=[2,1]\n[material]\nlibrary="DC04"\n'
    text += '[controls.pull]\nkind="displacement"\nnodes="x1"\ndirection="x"\n[[steps]]\nkind="move"\nto={pull=0.1}\n'
    problem = Problem.read(text)
    path = next(one for one in problem.paths() if one.path.startswith("material.hardening."))
    changed = problem.with_({path.path: 1.01 * path.value})
    key = path.path.rpartition(".")[2]
    law, known = changed.sheet().bodies.only.material, problem.sheet().bodies.only.material
    assert getattr(law.hardening, key) == 1.01 * getattr(known.hardening, key)
    assert replace(law, hardening=known.hardening) == known


def test_a_problem_takes_an_element_of_python_that_no_deck_has_words_for():
    own = replace(uf.elements.element("BEND8"), name="own")
    problem = problem_of(replace(BEND, element=own))
    assert problem.sheet().bodies.only.element.name == "own"
    with pytest.raises(InvalidValue, match="a deck has no words for this value"):
        problem.toml()


def test_errors_of_a_made_problem_are_those_of_python():
    with pytest.raises(uf.UmformError) as refused:
        problem_of(replace(BEND, element="BEND81")).build()
    assert "BEND81" in str(refused.value) and not isinstance(refused.value, DeckError)


def test_the_history_of_a_bend_is_that_of_its_problem_in_python():
    bend = air_bending(BEND, progress=False)
    again = problem_of(BEND).build().solve(progress=False)
    assert bend.result["stroke_force"].tolist() == again["stroke_force"].tolist()


def test_a_sweep_takes_a_problem_of_python(tmp_path):
    found = uf.sweep(
        problem_of(BEND),
        {"shoulder_radius": [2.0, 2.2]},
        measures=["stroke_force:peak"],
        out=tmp_path,
        processes=1,
        progress=False,
    )
    forces = [row["stroke_force:peak"] for row in found.rows]
    bend = air_bending(BEND, progress=False)
    assert forces[0] == bend.result["stroke_force"].max() > forces[1]


def test_the_cup_of_the_readme_keeps_its_allowed_penetration():
    """Penalties grow over the whole stroke; a state that is accepted too early lets them stop."""
    case = Cup(**ESAFORM | Cup.meshes["coarse"], material=uf.sheet_metals.get("AA6016-T4").law)
    drawn = draw(case, frames=0, progress=False)
    for pair in drawn.result.model.contacts:
        assert drawn.result[f"{pair.name}_penetration"].max() <= pair.allowed
