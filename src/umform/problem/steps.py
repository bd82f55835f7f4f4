"""The steps of a deck."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from umform.analysis import steps
from umform.model.contact import Contact
from umform.model.supports.support import Support
from umform.model.terms.control import Control
from umform.problem.parts import Name, Pair, Part
from umform.problem.tagged import table, with_keys
from umform.spec.types import Increments


@dataclass(frozen=True)
class Named:
    """Objects that steps refer to.

    Attributes
    ----------
    controls, supports, contacts : mapping
        By their names in the deck.
    """

    controls: Mapping[str, Control]
    supports: Mapping[str, Support]
    contacts: Mapping[str, Contact]


Targets = Annotated[dict[Name, float], Field(min_length=1)]
#: Approximate number of increments of a step at a pace.
_AT_A_PACE = 40
#: Approximate number of increments of a release: they grow from a thousandth to a twentieth of the way.
_OF_A_RELEASE = 30
#: Approximate number of increments of closing a tool.
_OF_CLOSING = 10


if TYPE_CHECKING:
    Pace = steps.Pace
else:
    Pace = table(steps.Pace)


@with_keys(steps.Move, leave=("control", "to", "steps", "follow"))
class Move(Part):
    """Move one or more controls along straight lines."""

    kind: Literal["move"]
    """The word move."""
    to: Targets
    """End value of each control."""
    increments: Increments | None = None
    """Number of equal increments; by default their size adapts, see pace."""
    pace: Pace | None = None
    """Limits of the changes in one increment, if their number is not given."""
    follow: dict[Name, Annotated[list[Pair], Field(min_length=1)]] = {}
    """Other controls as piecewise linear tables of the first one: pairs of its value and theirs."""

    @model_validator(mode="after")
    def _one_of_both(self) -> Move:
        if self.increments is not None and self.pace is not None:
            raise ValueError("give the number of increments or their pace, not both")
        return self

    def build(self, named: Named) -> steps.Step:
        """The step."""
        return steps.Move(
            [named.controls[name] for name in self.to],
            list(self.to.values()),
            steps=self.increments or self.pace,
            follow={named.controls[name]: law for name, law in self.follow.items()},
            **self.of_spec(),
        )

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return self.increments if self.increments is not None else _AT_A_PACE


class _Controlled(Part):
    """Common key of steps with one control."""

    control: Name
    """Which control."""


@with_keys(steps.Release, leave=("control",))
class Release(_Controlled):
    """Move a control back until its force is zero or contact is lost."""

    kind: Literal["release"]
    """The word release."""

    def build(self, named: Named) -> steps.Step:
        """The step."""
        return steps.Release(named.controls[self.control], **self.of_spec())

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return _OF_A_RELEASE


@with_keys(steps.Arc, leave=("control", "to", "until"), kind="length")
class Arc(Part):
    """Follow the equilibrium path through limit points while controls move along straight lines."""

    kind: Literal["arc"]
    """The word arc."""
    to: Targets
    """End value of each control."""

    def build(self, named: Named) -> steps.Step:
        """The step."""
        return steps.Arc([named.controls[name] for name in self.to], list(self.to.values()), **self.of_spec())

    @property
    def expected(self) -> int:
        """The largest number of increments."""
        most: int = self.of_spec()["most"]
        return most


@with_keys(steps.Free, leave=("support", "on"), steps="increments")
class Free(Part):
    """Remove a support, or open tools, gradually: their forces become loads that decrease to zero."""

    kind: Literal["free"]
    """The word free."""
    support: Name | None = None
    """Name of the support."""
    contacts: list[Name] = []
    """Contacts whose tools open."""
    on: Name | None = None
    """Name of a support of the kind rigid, which holds the sheet from then on."""

    @model_validator(mode="after")
    def _something(self) -> Free:
        if self.support is None and not self.contacts:
            raise PydanticCustomError("free", "a step frees a support, or contacts, or both")
        return self

    def build(self, named: Named) -> steps.Step:
        """The step."""
        things: list[Support | Contact] = [named.contacts[name] for name in self.contacts]
        if self.support is not None:
            things.insert(0, named.supports[self.support])
        on = None if self.on is None else named.supports[self.on]
        return steps.Free(things, on=on, **self.of_spec())

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        increments: int = self.of_spec()["steps"]
        return increments


@with_keys(steps.Close, leave=("control",))
class Close(_Controlled):
    """Close a pressed tool under displacement control until a force is reached, then hold the force."""

    kind: Literal["close"]
    """The word close."""

    def build(self, named: Named) -> steps.Step:
        """The step."""
        control = named.controls[self.control]
        return steps.Close(control, **self.of_spec())  # type: ignore[arg-type]

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return _OF_CLOSING


StepPart = Annotated[Move | Release | Arc | Free | Close, Field(discriminator="kind")]
