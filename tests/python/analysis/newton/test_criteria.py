"""When an iteration is converged: residual, increment, and an active set that has come to rest."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from one_unknown import Evaluated, OneUnknown

import umform as uf
from umform.analysis.newton.criteria import Criteria
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions


class Given(OneUnknown):
    """The n-th evaluation has a given residual and active set; the slope is 1."""

    def __init__(self, residuals, active):
        super().__init__(1.0)
        self.residuals, self.active, self.count = residuals, active, 0

    def evaluate(self, u, du=None, *, tangent=True, keep=False):
        self.count += 1
        residual = np.array([self.residuals[min(self.count, len(self.residuals)) - 1]])
        return Evaluated(
            x=u, residual=residual, values=np.ones(1), predictor=np.zeros(1), border=SimpleNamespace(unknowns=()),
            force_scale=1.0, failed=-1, round_off=0.0, flowing=np.zeros(0, dtype=np.uint8),
            status=np.array(self.active[min(self.count, len(self.active)) - 1], dtype=np.uint8), kept=False,
        )  # fmt: skip

    def recover(self, du, s, mixed=False):
        pass

    def revert(self):
        pass


def iterations(residuals, active, keep=False):
    return Newton(Given(residuals, active), NewtonOptions(mixed=False, keep=keep)).solve(None, np.zeros(1)).iterations


def test_a_small_residual_is_not_converged_while_the_active_set_changes():
    """The points that came into touch in the last iteration have not been asked what they do to the next one."""
    at_rest = iterations([1e-8, 1e-10], [[False]])
    assert [record.entered for record in at_rest] == [0, 0]
    moving = iterations([1e-8, 1e-10], [[False], [True], [True]])
    assert [record.entered for record in moving] == [0, 1, 0]
    assert [record.left for record in moving] == [0, 0, 0]


def test_drawing_takes_the_points_that_touch_now():
    moving = iterations([1e-8, 1e-10], [[False], [True], [True]], keep=True)
    assert [record.entered for record in moving] == [0, 1]


def test_a_point_that_leaves_counts_as_one_that_comes():
    records = iterations([1e-8, 1e-10], [[True, True], [True, False], [True, False]])
    assert [record.left for record in records] == [0, 1, 0]


def test_a_set_that_never_rests_is_granted_two_iterations():
    sets = [[k % 4 < 2, k % 3 == 0, k % 5 == 0] for k in range(40)]
    records = iterations([1e-8, 1e-10], sets)
    small = [record for record in records if record.residual < 1e-9]
    assert len(small) == 3
    assert all(record.entered + record.left for record in small)


@pytest.mark.parametrize(
    ("norm", "increment", "moved", "met"),
    [
        (1e-10, 1e-8, False, True),
        (1e-10, 1e-8, True, False),
        (1e-8, 1e-8, False, False),
        (1e-10, 1e-5, False, False),
    ],
)
def test_residual_increment_and_active_set_must_agree(norm, increment, moved, met):
    system = Given([0.0], [[False]])
    criteria = Criteria(system, 1e-9, 1e-6)
    assert criteria.met(norm, increment, np.ones(1), system.evaluate(system.x), moved=moved, solved=True) is met


@pytest.mark.parametrize("solved", [True, False])
def test_nothing_has_moved_counts_after_a_solution_only(solved):
    """eq. (5.40): a predicted increment of zero proves nothing, however small the residual beside the stiffness is."""
    system = Given([0.0], [[False]])
    evaluation = system.evaluate(system.x)
    evaluation.force_scale = 1e-17
    criteria = Criteria(system, 1e-9, 1e-6)
    assert criteria.met(1e-17, 0.0, np.zeros(1), evaluation, moved=False, solved=solved) is solved


def test_a_displacement_beyond_round_off_must_have_a_small_increment():
    """eq. (5.40) is for a system that does not move: a small residual alone is not enough for one that does."""
    system = Given([0.0], [[False]])
    evaluation = system.evaluate(system.x)
    evaluation.force_scale = 1e-17
    criteria = Criteria(system, 1e-9, 1e-6)
    assert not criteria.met(1e-17, 1e-5, np.ones(1), evaluation, moved=False, solved=True)


@pytest.mark.parametrize(("size", "moves"), [(1e-17, False), (1e-12, True)])
def test_an_increment_below_the_round_off_of_positions_is_none(size, moves):
    """A sheet that lies on a tool without forces would be shaken off it."""
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (4, 1)), material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    started, evaluate = [], model.system.evaluate
    model.system.evaluate = lambda at, *given, **more: started.append(at.x.copy()) or evaluate(at, *given, **more)
    Newton(model.system).solve(None, np.full(model.system.x.size, size))
    assert started[0].any() == moves
