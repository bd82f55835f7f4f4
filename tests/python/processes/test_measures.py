import numpy as np
import pytest

from umform.processes.bending.measures import at_marks, jump, roughness

u = np.linspace(0.0, 15.0, 301)


def test_values_at_marks_and_beyond_the_end():
    assert at_marks(u, 2 * u, (1.03, 15.0, 16.0)) == [pytest.approx(2.06), pytest.approx(30.0), None]


def test_jump_of_a_stair_is_its_height():
    F = np.where(u < 8.0, 10.0, 12.0)
    assert jump(u, F, start=2.0, window=0.1) == pytest.approx(0.2)
    assert jump(u, F, start=9.0, window=0.1) == 0.0


def test_jump_does_not_depend_on_the_increments_of_a_ramp():
    F = 10.0 + u
    expected = 0.1 / 12.0
    assert jump(u, F, 2.0, 0.1) == pytest.approx(expected)
    assert jump(u[::5], F[::5], 2.0, 0.1) == pytest.approx(expected)


def test_smooth_curves_have_no_roughness():
    F = 10 + u - 0.3 * u**2 + 0.02 * u**3
    assert roughness(u, F, 2.0) < 1e-12


def test_roughness_of_a_wave_is_its_root_mean_square():
    F = 100.0 + np.sin(20.0 * u)
    assert roughness(u, F, 2.0) == pytest.approx(np.sqrt(0.5) / 100, rel=0.02)


def test_too_short_curves_have_no_measures():
    assert jump(u[:3], u[:3], 2.0, 0.1) is None
    assert roughness(u[:3], u[:3], 2.0) is None
