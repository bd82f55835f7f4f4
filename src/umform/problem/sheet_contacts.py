"""The contacts of sheets of a deck: faces of two sheets, or of one that touches itself."""

from __future__ import annotations

from umform.model import Model
from umform.model.contact.sheets import SheetContact, SheetContactOptions
from umform.problem.parts import Part
from umform.problem.selection import Selection, faces_of


class SheetContactPart(Part, of=SheetContactOptions):
    """Contact of lower or upper faces with those of another sheet, or of a sheet with itself."""

    faces: Selection
    """Lower or upper faces."""
    others: Selection | None = None
    """Faces of the other sheet; without them the faces touch themselves, as in a hem."""

    def __post_init__(self) -> None:
        """Refuse options that do not belong together."""
        SheetContactOptions(**self.of_spec())

    def add_to(self, model: Model, name: str) -> SheetContact:
        """Add the contact to the model."""
        faces = faces_of(model.mesh, self.faces)
        if self.others is None:
            return model.self_contact(faces, name=name, **self.of_spec())
        return model.sheet_contact(faces, faces_of(model.mesh, self.others), name=name, **self.of_spec())
