"""The element of a deck: a name of the catalogue and its options."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from umform.elements import CATALOGUE
from umform.elements import element as catalogue_element
from umform.elements.technology import Element
from umform.problem.parts import Own, Part


class ElementPart(Part):
    """Element, its options, and the points through the thickness."""

    name: Annotated[str, Field(json_schema_extra={"enum": list(CATALOGUE)})] | Own[Element] = "ANS3DEAS"
    """Name in the catalogue; `umform elements` lists it. In Python also an element of your own."""
    thickness_modes: Literal[1, 4, 9] | None = None
    """Enhanced modes of the thickness strain."""
    thickness_order: Annotated[int, Field(ge=1, le=19)] | None = None
    """Order of the thickness strain; by default complete with a plastic law: the number of points minus one."""
    order_modes: Literal[1, 4, 9] | None = None
    """Modes in the surface for each order above 1."""
    membrane_modes: Literal[4, 5, 7] | None = None
    """Enhanced in-plane modes of EAS3DEAS."""
    tie_E33: bool | None = None
    """Tie the thickness strain."""
    compatible_E12: bool | None = None
    """Omit the tying of E_12 in MI9K3DEAS or BEND18."""
    plane_strain: bool | None = None
    """Fewer Gauss points across a strip of one element whose nodes are all held across it; same results."""
    thickness_points: Annotated[int, Field(ge=2, le=20)] | None = None
    """Points through the thickness; by default those of the material."""
    thickness_rule: Literal["gauss", "lobatto", "split", "graded", "staggered"] | None = None
    """Quadrature rule; by default gauss, but staggered if the default of the material applies."""

    def options(self) -> dict[str, Any]:
        """The given options, for the catalogue and the model."""
        through = {"name", "thickness_points", "thickness_rule"}
        return self.model_dump(exclude=through, exclude_none=True)

    def build(self) -> Element:
        """The element."""
        return self.name if isinstance(self.name, Element) else catalogue_element(self.name, **self.options())
