"""The draw beads of a deck: lines on the tools of contacts."""

from __future__ import annotations

from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.bead import Bead, BeadOptions
from umform.problem.parts import Name, Part
from umform.problem.selection import Selection, faces_of


class BeadPart(Part, of=BeadOptions):
    """An equivalent draw bead: a line on the tool of a contact that restrains the sheet."""

    contact: Name
    """Contact whose tool has the line."""
    faces: Selection | None = None
    """Faces that pass the bead; by default those of the contact."""

    def add_to(self, model: Model, contact: Contact, name: str) -> Bead:
        """Add the bead to the model."""
        faces = contact.faces if self.faces is None else faces_of(model.mesh, self.faces)
        return model.bead(faces, contact, name=name, **self.of_spec())
