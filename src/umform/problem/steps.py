"""The steps of a deck."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from umform import steps
from umform.model.contact import Contact
from umform.model.control import Control
from umform.model.support import Support
from umform.problem.parts import Count, Name, Pair, Part, Positive


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
Cuts = Annotated[int, Field(ge=0, le=40)]
Grow = Annotated[float, Field(ge=1)]
#: A fraction of a step.
Share = Annotated[float, Field(gt=0, le=1)]
#: Approximate number of increments of a step at a pace.
_AT_A_PACE = 40
#: Approximate number of increments of a release: they grow from a thousandth to a twentieth of the way.
_OF_A_RELEASE = 30
#: Approximate number of increments of closing a tool.
_OF_CLOSING = 10


class Pace(Part):
    """Limits of the changes in one increment."""

    first: Share = steps.Pace.first
    """First increment, as a fraction of the step."""
    largest: Share = steps.Pace.largest
    """Largest increment, as a fraction of the step."""
    turn: Positive = steps.Pace.turn
    """Rotation of a fibre through the thickness, in degrees."""
    strain: Positive = steps.Pace.strain
    """Increase of the plastic strain at a point."""
    contact: Positive = steps.Pace.contact
    """Fraction of the contact points that open or close."""
    iterations: Count = steps.Pace.iterations
    """Newton iterations to which the size is adapted."""
    work: Positive = steps.Pace.work
    """Difference of work and energies, relative to the energy, above which an increment is repeated in halves."""

    def build(self) -> steps.Pace:
        """The limits."""
        return steps.Pace(**self.model_dump())


class Move(Part):
    """Move one or more controls along straight lines."""

    kind: Literal["move"]
    """The word move."""
    to: Targets
    """End value of each control."""
    increments: Annotated[int, Field(ge=1, le=1_000_000)] | None = None
    """Number of equal increments; by default their size adapts, see pace."""
    pace: Pace | None = None
    """Limits of the changes in one increment, if their number is not given."""
    cuts: Cuts = 10
    """How often an increment may be halved."""
    grow: Grow = 1.0
    """Largest increment relative to the nominal one, if their number is given."""
    follow: dict[Name, Annotated[list[Pair], Field(min_length=1)]] = {}
    """Other controls as piecewise linear tables of the first one: pairs of its value and theirs."""
    time: Positive = 1.0
    """Duration of the step: for rate-dependent metals, and for motions in time."""

    @model_validator(mode="after")
    def _one_of_both(self) -> Move:
        if self.increments is not None and self.pace is not None:
            raise ValueError("give the number of increments or their pace, not both")
        return self

    def build(self, named: Named) -> steps.Step:
        """The step."""
        moved = [named.controls[name] for name in self.to]
        limits = None if self.pace is None else self.pace.build()
        return steps.Move(
            moved,
            list(self.to.values()),
            steps=self.increments or limits,
            cuts=self.cuts,
            grow=self.grow,
            follow={named.controls[name]: table for name, table in self.follow.items()},
            time=self.time,
        )

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return self.increments if self.increments is not None else _AT_A_PACE


class Release(Part):
    """Move a control back until its force is zero or contact is lost."""

    kind: Literal["release"]
    """The word release."""
    control: Name
    """Which control."""
    increment: Positive | None = None
    """First increment; by default 1/1000 of the present value."""
    tolerance: Positive = 1e-6
    """Force that counts as zero, relative to that at the beginning."""
    time: Positive = 1.0
    """Time for the full way back to zero: for rate-dependent metals, and for motions in time."""

    def build(self, named: Named) -> steps.Step:
        """The step."""
        return steps.Release(named.controls[self.control], self.increment, self.tolerance, self.time)

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return _OF_A_RELEASE


class Arc(Part):
    """Follow the equilibrium path through limit points while controls move along straight lines."""

    kind: Literal["arc"]
    """The word arc."""
    to: Targets
    """End value of each control."""
    increment: Annotated[float, Field(gt=0, le=1)] = 0.05
    """First increment of the load parameter, which goes from 0 to 1."""
    length: Literal["cylindrical", "spherical"] = "cylindrical"
    """Length of an increment: of displacements, or of displacements and load parameter."""
    iterations: Count = 6
    """Iterations to which the arc length is adapted."""
    grow: Grow = 4.0
    """Ratio of the largest arc length to the first."""
    cuts: Cuts = 10
    """How often the first arc length may be halved."""
    most: Annotated[int, Field(ge=1, le=1_000_000)] = 200
    """Number of increments at which the step ends with a warning."""
    time: Positive = 1.0
    """Time for the path to the end at the rate of the first increment: for rate-dependent metals."""

    def build(self, named: Named) -> steps.Step:
        """The step."""
        return steps.Arc(
            [named.controls[name] for name in self.to],
            list(self.to.values()),
            increment=self.increment,
            kind=self.length,
            iterations=self.iterations,
            grow=self.grow,
            cuts=self.cuts,
            most=self.most,
            time=self.time,
        )

    @property
    def expected(self) -> int:
        """The largest number of increments."""
        return self.most


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
    increments: Annotated[int, Field(ge=1, le=1_000_000)] = 10
    """Number of equal increments."""
    cuts: Cuts = 10
    """How often an increment may be halved."""
    grow: Grow = 1.0
    """Largest increment relative to the nominal one."""
    time: Positive = 1.0
    """Duration of the step: for rate-dependent metals, and for motions in time."""

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
        return steps.Free(things, steps=self.increments, cuts=self.cuts, grow=self.grow, on=on, time=self.time)

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return self.increments


class Close(Part):
    """Close a pressed tool under displacement control until a force is reached, then hold the force."""

    kind: Literal["close"]
    """The word close."""
    control: Name
    """Control of the kind press, spring or moment."""
    force: float
    """Closing force (or moment)."""
    way: Positive | None = None
    """Largest displacement; by default its distance from the sheet and the largest extent of the sheet."""
    time: Positive = 1.0
    """Duration of the step: for rate-dependent metals, and for motions in time."""

    def build(self, named: Named) -> steps.Step:
        """The step."""
        control = named.controls[self.control]
        return steps.Close(control, self.force, self.way, self.time)  # type: ignore[arg-type]

    @property
    def expected(self) -> int:
        """Approximate number of increments."""
        return _OF_CLOSING


StepPart = Annotated[Move | Release | Arc | Free | Close, Field(discriminator="kind")]
