"""A contact by a penalty, with tools or of sheets: penalty, multipliers, and results of the converged state."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, ModelError
from umform.model.contact.friction import AnyFriction
from umform.model.contact.own_law import AnyContactLaw
from umform.model.terms.elsewhere import not_here
from umform.model.terms.term import Found, Term

Floats = NDArray[np.float64]
F = TypeVar("F", bound=Found)


@dataclass(frozen=True, kw_only=True)
class PenaltySettings:
    """Settings that contacts with tools and of sheets share.

    Attributes
    ----------
    penalty : float
        Pressure per penetration.
    allowed : float, optional
        Allowed penetration; None if only a penalty was given, infinite if any is allowed.
    augmented : bool
        Whether multipliers reduce the penetration to the allowed one, and the elastic slip.
    friction : float, Friction, FrictionByRegion or callable, optional
        Friction law; None without friction.
    largest : float
        Penalty up to which it grows in a run where it leaves more than the allowed penetration. An estimate does; a
        given penalty, a law of one's own and multipliers do not, and have 0.
    """

    penalty: float
    allowed: float | None = None
    augmented: bool = False
    friction: AnyFriction | None = None
    largest: float = 0.0


class Penalised(Term, Generic[F]):
    """A contact whose pressure follows from a penalty, which may grow in a run, or from multipliers.

    Parameters
    ----------
    settings : PenaltySettings
        Penalty, allowed penetration, multipliers, friction.
    name : str
        For the history.
    """

    timed_as = "contact"
    #: Whether an augmentation failed in the last increment, so that the multipliers kept their values.
    multipliers_stay = False

    before: Floats

    def __init__(self, settings: PenaltySettings, name: str) -> None:
        self.name = name
        self._settings, self._penalty = settings, settings.penalty
        self._standing_penalty = self._initial_penalty = settings.penalty
        self.elsewhere = False
        self.before = np.empty(0)
        self._last: F | None = None

    # Settings ----------------------------------------------------------------------------------------------------

    @property
    def allowed(self) -> float | None:
        """Allowed penetration; None if only a penalty was given, infinite if any is allowed."""
        return self._settings.allowed

    @property
    def augmented(self) -> bool:
        """Whether multipliers reduce the penetration to the allowed one."""
        return self._settings.augmented

    @property
    def adapts(self) -> bool:
        """Whether the penalty grows in a run, so that no point exceeds the allowed penetration."""
        return self._settings.largest > 0.0 and self.allowed not in (None, math.inf)

    @property
    def law(self) -> AnyContactLaw | None:
        """Contact law of the user; None where the pressure follows from the penalty."""
        return None

    @property
    def friction(self) -> AnyFriction | None:
        """Friction law; None without friction."""
        return self._settings.friction

    @property
    def has_friction(self) -> bool:
        """Whether it has a slip history."""
        return self.friction is not None

    # Penalty -----------------------------------------------------------------------------------------------------

    @property
    def largest_penalty(self) -> float:
        """Penalty up to which it grows in a run; 0 if it does not."""
        return self._settings.largest

    @property
    def initial_penalty(self) -> float:
        """Penalty at the start: given, estimated, or that of a stage before."""
        return self._initial_penalty

    @property
    def softest_penalty(self) -> float:
        """Penalty to which grown ones may return: given or estimated; that of a stage before had grown, too."""
        return min(self._settings.penalty, self._initial_penalty)

    @property
    def penalty(self) -> float:
        """Pressure per penetration; what is set here stays as it is in a run."""
        return self._penalty

    @penalty.setter
    def penalty(self, value: float) -> None:
        if self.law is not None:
            raise InvalidValue(
                "a contact with a law of its own has no penalty to be set",
                where=f"contact {self.name}, penalty",
                value=value,
                cause="the law has the stiffness of the contact",
                remedy="another law: model.contact(..., law=...)",
            )
        self._settings = replace(self._settings, penalty=value, largest=0.0)
        self._initial_penalty = value
        self._restore_penalty(value)

    def begin_with(self, penalty: float) -> None:
        """Begin with the penalty of a stage before, if it is estimated and grows; 0: there was none."""
        if self.adapts and penalty > 0.0:
            self._initial_penalty = min(penalty, self.largest_penalty)
            self._restore_penalty(self._initial_penalty)

    def _restore_penalty(self, value: float) -> None:
        """Set the penalty of the converged state, and evaluate with it."""
        self._standing_penalty = value
        self.use_penalty(value)

    def use_penalty(self, value: float) -> None:
        """Evaluate with this penalty from now on."""
        self._penalty = value

    # The converged state -----------------------------------------------------------------------------------------

    @property
    def found(self) -> F:
        """Results at the converged state.

        Raises
        ------
        ModelError
            If the model has not been solved yet; use ``model.evaluate(u).found[contact]`` then. If it was solved on
            many ranks, which hold the points of their facets.
        """
        self._refuse_elsewhere()
        if self._last is None:
            raise ModelError(
                f"nothing is known of contact {self.name} yet",
                cause="the model has not been solved since it was made or put back",
                remedy="model.evaluate(model.u).found[contact]",
            )
        return self._last

    def stand(self, found: F) -> None:
        """Store the results of the converged state."""
        self._last = found

    def _refuse_elsewhere(self) -> None:
        if self.elsewhere:
            raise not_here(f"the state of contact {self.name}")
