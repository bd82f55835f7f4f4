"""Laws and tools of the user in a model: how to check their derivatives, and whether Newton's method misses them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from umform.materials import CompiledLaw, Umat, UserLaw
from umform.model import Model
from umform.results.records import Iteration
from umform.surfaces import UserSurface

_OWN_LAWS = (UserLaw, CompiledLaw, Umat)
#: Fewest iterations of an increment that is slow, how many of its last ones count, and their least ratio of residuals.
_MANY, _LAST, _RATIO = 8, 4, 0.15


def own_checks(model: Model) -> list[str]:
    """The checks of the laws and tools of the user in a model, as sentences; empty without any."""
    laws = [getattr(body.material, "small", body.material) for body in model.bodies]
    checks = [
        (
            "check_law compares the tangent of your law",
            any(isinstance(one, UserLaw | CompiledLaw | Umat) for one in laws),
        ),
        (
            "check_surface the derivatives of your tool",
            any(isinstance(one.surface, UserSurface) for one in model.tools),
        ),
        ("check_contact_law the derivative of your contact law", any(pair.law is not None for pair in model.contacts)),
    ]
    return [check for check, own in checks if own]


def own_parts(model: Model) -> str:
    """The same as the end of a remedy."""
    return "".join(f"; {check} with differences" for check in own_checks(model))


def linear_rate(iterations: Sequence[Iteration]) -> float | None:
    """Mean ratio of the last residuals if they fall by nearly the same factor; None where they fall faster.

    A consistent tangent squares the error from one iteration to the next. Iterations in which points change their
    state, or increments are shortened, say nothing of it.
    """
    tail = iterations[-_LAST - 1 :]
    changes = any(one.entered or one.left or one.switched or one.step_length != 1.0 for one in tail)
    if len(iterations) < _MANY or changes or any(one.residual <= 0.0 for one in tail):
        return None
    ratios = [after.residual / before.residual for before, after in pairwise(tail)]
    if not all(_RATIO <= ratio < 1.0 for ratio in ratios):
        return None
    return float((tail[-1].residual / tail[0].residual) ** (1.0 / _LAST))
