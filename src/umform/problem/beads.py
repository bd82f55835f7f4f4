"""The draw beads of a deck: lines on the tools of contacts."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.bead import Bead
from umform.problem.parts import Name, NotNegative, Part, Positive, Vector
from umform.problem.selection import Selection, faces_of


class BeadPart(Part):
    """An equivalent draw bead: a line on the tool of a contact that restrains the sheet."""

    contact: Name
    """Contact whose tool has the line."""
    curve: Annotated[list[Vector], Field(min_length=2)]
    """Corners of the line on the tool, in its initial position."""
    restraint: NotNegative
    """Restraining force per length across the line."""
    uplift: NotNegative = 0.0
    """Lifting force per length off the tool."""
    width: Positive
    """Width of the band over which the forces are spread."""
    closed: bool = False
    """Whether the last point is joined to the first."""
    faces: Selection | None = None
    """Faces that pass the bead; by default those of the contact."""
    slip: Positive | None = None
    """Allowed elastic slip; by default 1/200 of the thickness."""
    points: Annotated[int, Field(ge=1, le=10)] | None = None
    """Gauss points per direction of a face; by default as many as the band needs."""

    def add_to(self, model: Model, contact: Contact, name: str) -> Bead:
        """Add the bead to the model."""
        return model.bead(
            contact.faces if self.faces is None else faces_of(model.mesh, self.faces),
            contact,
            self.curve,
            restraint=self.restraint,
            uplift=self.uplift,
            width=self.width,
            closed=self.closed,
            slip=self.slip,
            points=self.points,
            name=name,
        )
