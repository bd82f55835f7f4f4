"""Tools of the user are checked beside the sheet when a contact is defined."""

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue

R, CENTRE = 8.0, np.array([0.0, 0.0, 8.7])


def ball(x):
    p = x - CENTRE
    length = np.linalg.norm(p, axis=1)
    n = p / length[:, None]
    return length - R, n, (np.eye(3) - n[:, :, None] * n[:, None, :]) / length[:, None, None]


def scaled(x):
    return tuple(0.5 * part for part in ball(x))


def inward(x):
    g, n, H = ball(x)
    return g, -n, H


def flat(x):
    g, n, H = ball(x)
    return g, n, 0.0 * H


def unit_normal(x):
    g, n, H = scaled(x)
    return g, 2.0 * n, 2.0 * H


def contact_with(function):
    sheet = uf.mesh.strip(length=10, width=10, thickness=1, cells=(3, 3))
    model = uf.Model(sheet, "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    return model.contact("upper", uf.UserSurface(function, name="mine"), name="ball")


@pytest.mark.parametrize("function", [ball, scaled])
def test_a_consistent_tool_is_taken_in_silence(function, caplog):
    contact_with(function)
    assert not [record for record in caplog.records if record.levelname == "WARNING"]


def test_a_normal_into_the_tool_is_refused():
    with pytest.raises(InvalidValue, match="not the gradient") as caught:
        contact_with(inward)
    assert "normal into the tool" in caught.value.cause
    assert "check_surface" in caught.value.remedy
    assert caught.value.where == "contact ball, mine"


@pytest.mark.parametrize(("function", "words"), [(flat, "Hessian"), (unit_normal, "deviates from the gradient")])
def test_a_wrong_hessian_or_length_of_the_normal_warns(function, words, caplog):
    contact_with(function)
    (record,) = [record for record in caplog.records if record.levelname == "WARNING"]
    assert words in record.getMessage()
    assert "contact ball, mine" in record.getMessage()


def test_a_tool_that_is_not_defined_beside_the_sheet_is_left_to_the_run():
    sheet = uf.mesh.strip(length=10, width=10, thickness=1, cells=(3, 3))
    model = uf.Model(sheet, "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    nowhere = uf.UserSurface(lambda x: (np.full(len(x), np.nan), x, np.zeros((len(x), 3, 3))))
    assert model.contact("upper", nowhere, penalty=1.0).name == "tool1"


def force(function, penalty):
    sheet = uf.mesh.strip(length=10, width=10, thickness=1, cells=(3, 3))
    model = uf.Model(sheet, "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.fix("x0")
    model.fix("lower")
    stroke = model.drive(model.contact("upper", uf.UserSurface(function), penalty=penalty, name="ball"), "z")
    return uf.solve(model, uf.Move(stroke, to=-0.3, steps=1), progress=False)["ball_fz"][-1]


def test_the_pressure_scales_with_the_square_of_the_length_of_the_gradient():
    """Traction p g grad g: half the distance needs four times the penalty."""
    expected = force(ball, 100.0)
    assert abs(expected) > 1.0
    assert force(scaled, 400.0) == pytest.approx(expected, rel=1e-12)
    x = CENTRE + np.array([[0.0, 0.0, -7.9], [1.0, 0.0, -7.8]])
    look = uf.check_surface(uf.UserSurface(scaled), x, 1e-4)
    assert look.ok(1e-6)
    assert look.gradient_length == pytest.approx(0.5, abs=1e-6)
