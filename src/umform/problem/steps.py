"""The steps of a deck."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Literal

from umform.analysis import steps
from umform.errors import InvalidValue
from umform.model.contact import Contact
from umform.model.supports.support import Support
from umform.model.terms.control import Control
from umform.problem.notes import Field
from umform.problem.parts import Name, Pair, Part
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


def _twice(what: str, where: str, value: object) -> InvalidValue:
    """Error for two keys of which one is needed."""
    return InvalidValue(
        f"{what} are both given",
        where=where,
        value=value,
        cause="each sets the size of increments",
        remedy="one of them",
    )


class Move(Part, of=steps.Move, leave=("control", "to", "steps", "follow")):
    """Move one or more controls along straight lines."""

    kind: Literal["move"]
    to: Targets
    """End value of each control."""
    increments: Increments | None = None
    """Number of equal increments; by default their size adapts, see pace."""
    pace: steps.Pace | None = None
    """Limits of the changes in one increment, if their number is not given."""
    follow: dict[Name, Annotated[list[Pair], Field(min_length=1)]] = field(default_factory=dict)
    """Other controls as piecewise linear tables of the first one: pairs of its value and theirs."""

    def __post_init__(self) -> None:
        """Refuse a number of increments together with a pace."""
        if self.increments is not None and self.pace is not None:
            raise _twice("the number of increments and their pace", "increments", self.increments)

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


class Release(_Controlled, of=steps.Release, leave=("control",), called={"steps": "increments"}):
    """Move a control back until its force is zero or contact is lost."""

    kind: Literal["release"]

    def __post_init__(self) -> None:
        """Refuse a first increment together with a number of them."""
        given = self.of_spec()
        if given["increment"] is not None and given["steps"] is not None:
            raise _twice("the number of increments and the first one", "increments", given["steps"])

    def build(self, named: Named) -> steps.Step:
        """The step."""
        return steps.Release(named.controls[self.control], **self.of_spec())

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return int(self.of_spec()["steps"] or _OF_A_RELEASE)


class Arc(Part, of=steps.Arc, leave=("control", "to", "until"), called={"kind": "length"}):
    """Follow the equilibrium path through limit points while controls move along straight lines."""

    kind: Literal["arc"]
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


class Free(Part, of=steps.Free, leave=("support", "on"), called={"steps": "increments"}):
    """Remove a support, or open tools, gradually: their forces become loads that decrease to zero."""

    kind: Literal["free"]
    support: Name | None = None
    """Name of the support."""
    contacts: list[Name] = field(default_factory=list)
    """Contacts whose tools open."""
    on: Name | None = None
    """Name of a support of the kind rigid, which holds the sheet from then on."""

    def __post_init__(self) -> None:
        """Refuse a step that frees nothing."""
        if self.support is None and not self.contacts:
            raise InvalidValue(
                "a step frees a support, or contacts, or both",
                cause="neither is given",
                remedy='support = "clamp", or contacts = ["die", "holder"]',
            )

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


class Close(_Controlled, of=steps.Close, leave=("control",)):
    """Close a pressed tool under displacement control until a force is reached, then hold the force."""

    kind: Literal["close"]

    def build(self, named: Named) -> steps.Step:
        """The step."""
        control = named.controls[self.control]
        return steps.Close(control, **self.of_spec())  # type: ignore[arg-type]

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return _OF_CLOSING


StepPart = Annotated[Move | Release | Arc | Free | Close, Field(discriminator="kind")]
