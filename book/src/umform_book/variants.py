"""The elements that a case runs through: all seven of the catalogue, each with and without the tying of E_33."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from umform.elements import element
from umform.elements.technology import Element

Options = Mapping[str, Any]


@dataclass(frozen=True)
class Variant:
    """An element of the catalogue with its options; at thickness order 1, as in the literature, if they name none.

    Attributes
    ----------
    name : str
        Name in the catalogue.
    options : mapping
        Its options, as :func:`umform.elements.element` takes them.
    note : str
        What is added to the name in tables, such as "tied".
    """

    name: str
    options: Options = field(default_factory=dict)
    note: str = ""

    def __hash__(self) -> int:
        return hash((self.name, self.note, tuple(sorted(self.options.items()))))

    @property
    def label(self) -> str:
        """Name in tables and legends."""
        return f"{self.name}, {self.note}" if self.note else self.name

    @property
    def element(self) -> Element:
        """The element: those for bends have their complete order."""
        made = element(self.name, **self.options)
        return replace(made, complete=made.raised and self.name.startswith("BEND"))

    @property
    def cell(self) -> str:
        """Its cell type."""
        return self.element.cell

    def cells(self, divisions: int) -> int:
        """Number of elements along an edge with this many intervals between nodes, so that equal meshes compare."""
        return divisions if self.cell == "hex8" else divisions // 2


def with_tying(name: str) -> Variant:
    """An element with E_33 tied."""
    return Variant(name, {"tie_E33": True}, "E_33 tied")


SEVEN = ("DISP3D", "DISP3DEAS", "ANS3DEAS", "EAS3DEAS", "DISP9K3D", "DISP9K3DEAS", "MI9K3DEAS")

#: All seven elements, without and with tying of E_33.
VARIANTS: tuple[Variant, ...] = tuple(v for name in SEVEN for v in (Variant(name), with_tying(name)))
#: Those that do not lock in thin shells: what an engineer would take.
GOOD: tuple[Variant, ...] = tuple(v for v in VARIANTS if v.name in ("ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"))
