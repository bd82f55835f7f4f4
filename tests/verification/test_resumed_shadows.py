"""A run with shadows that is stopped anywhere goes on to the same bits, whatever its steps and tools."""

from __future__ import annotations

import itertools
import shutil

import numpy as np
import pytest

from umform.analysis.run.checkpoint import Checkpoints
from umform.analysis.shadows import resume_with_shadows, solve_with_shadows
from umform_book.derivatives.sheets import SHEETS
from umform_book.derivatives.steps import EXAMPLES

MODELS = EXAMPLES | {name: one for name, one in SHEETS.items() if "friction" in name}


def builds(example, change=1e-4):
    """The run, its reference, and two shadows."""
    name, other = list(example.values)[:2]

    def built(**changed):
        model, steps = example.build(**{**example.values, **changed})
        return model, steps

    shadows = {key: built(**{key: example.values[key] * (1.0 + change)}) for key in (name, other)}
    return built(), built(), shadows


def assert_the_same(found, expected):
    for one, other in [
        (found.run, expected.run),
        (found.reference, expected.reference),
        *((found.shadows[key], expected.shadows[key]) for key in expected.shadows),
    ]:
        assert one.columns() == other.columns()
        for column in one.columns():
            np.testing.assert_array_equal(one[column], other[column], err_msg=column)
        np.testing.assert_equal(vars(one.model.system.snapshot()), vars(other.model.system.snapshot()))
        assert (one.events, one.warnings) == (other.events, other.warnings)
        assert [frame.number for frame in one.frames] == [frame.number for frame in other.frames]
    assert found.kept == expected.kept


@pytest.fixture
def copies(monkeypatch, tmp_path):
    """Copies of every third checkpoint; the others are not written."""
    write, paths, asked = Checkpoints.write, [], itertools.count()

    def write_and_copy(self, run):
        if next(asked) % 3 == 0:
            write(self, run)
            paths.append(shutil.copy(self.path, tmp_path / f"copy{len(paths)}.h5"))

    monkeypatch.setattr(Checkpoints, "write", write_and_copy)
    return paths


@pytest.mark.parametrize("part", [0.5, pytest.param(1.0, marks=pytest.mark.long)])
@pytest.mark.parametrize("name", MODELS)
def test_from_any_place_to_the_same_bits(name, part, copies, tmp_path):
    expected = solve_with_shadows(*builds(MODELS[name]), frames=2, checkpoint=tmp_path / "run.h5", every=0)
    assert not any(kept.lost for kept in expected.kept.values())
    place = copies[min(int(part * len(copies)), len(copies) - 1)]
    again = resume_with_shadows(place, *builds(MODELS[name]), frames=2, every=1e9)
    assert_the_same(again, expected)
