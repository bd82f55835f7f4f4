"""The element of a deck: a name of the catalogue and its options."""

from __future__ import annotations

from typing import Annotated

from umform.elements import CATALOGUE, BodyOptions
from umform.elements import element as catalogue_element
from umform.elements.technology import Element
from umform.problem.notes import Field, Own
from umform.problem.parts import Part


class ElementPart(Part, of=BodyOptions):
    """Element, its options, and the points through the thickness."""

    name: Annotated[str, Field(json_schema_extra={"enum": list(CATALOGUE)})] | Own[Element] = "ANS3DEAS"
    """Name in the catalogue; `umform elements` lists it. In Python also an element of your own."""

    def build(self) -> Element:
        """The element."""
        return catalogue_element(self.name, **BodyOptions(**self.of_spec()).of_element())
