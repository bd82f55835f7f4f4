"""The rolling direction as a field: it turns with the cell and not with its stretch."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.model import Body

FLAT = uf.mesh.strip(4, 2, 0.5, (2, 1))


def field(gradient, rolling=(1.0, 1.0, 0.0)):
    """Field of a flat sheet whose displacement has a constant gradient."""
    model = uf.Model(FLAT, "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3), rolling=rolling)
    model.u[:] = (FLAT.points @ np.array(gradient).T).ravel()
    return uf.fields.cell_fields(model)["rolling"]


def test_it_is_that_of_the_sheet_at_rest():
    assert field(np.zeros((3, 3))) == pytest.approx(np.tile([np.sqrt(0.5), np.sqrt(0.5), 0.0], (2, 1)))


def test_a_rotation_turns_it():
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    found = field(turn - np.eye(3))
    assert found == pytest.approx(np.tile(turn @ [np.sqrt(0.5), np.sqrt(0.5), 0.0], (2, 1)), abs=1e-12)


def test_a_stretch_does_not():
    found = field(np.diag([0.5, -0.2, 0.0]))
    assert found == pytest.approx(np.tile([np.sqrt(0.5), np.sqrt(0.5), 0.0], (2, 1)), abs=1e-12)


def test_by_vector_field_function_and_angle():
    """All four say the same; the field and the function differ from cell to cell."""
    still = np.zeros((3, 3))
    centres = FLAT.points[FLAT.connectivity].mean(axis=1)
    each = np.column_stack([centres[:, 0], np.ones(2), np.zeros(2)])
    assert field(still, each) == pytest.approx(field(still, lambda x, y, z: np.column_stack([x, 1 + 0 * y, 0 * z])))
    assert not np.allclose(field(still, each)[0], field(still, each)[1])
    assert field(still, uf.rolling_at(-45)) == pytest.approx(field(still))
    assert uf.rolling_at(90, line=(0, 1, 0)) == pytest.approx((-1.0, 0.0, 0.0))
    assert uf.rolling_at(0, line=(0, 0, 2), normal=(1, 0, 0)) == (0.0, 0.0, 1.0)


def test_bodies_without_one_have_none():
    law = uf.SVK(E=1000.0, nu=0.3)
    one = Body(material=law, cells=[0], name="one", rolling=(0, 1, 0))
    other = Body(material=law, cells=[1], name="other")
    found = uf.fields.cell_fields(uf.Model(FLAT, bodies=[one, other]))["rolling"]
    assert found.tolist() == [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]
    assert "rolling" not in uf.fields.cell_fields(uf.Model(FLAT, material=law))


@pytest.mark.parametrize("wrong", [(np.nan, (0, 1, 0), (0, 0, 1)), (45, (0, 0, 1), (0, 0, 1)), (45, (0, 1), (0, 0, 1))])
def test_what_has_no_direction_is_refused(wrong):
    with pytest.raises((InvalidValue, ValueError)):
        uf.rolling_at(*wrong)
