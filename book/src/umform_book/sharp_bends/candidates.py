"""Elements of this chapter: an element with its points and layers through the thickness; the steel of all cases."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.materials import J2, Linear, Perfect
from umform.model import Model
from umform_book.variants import Variant

Floats = NDArray[np.float64]

KAPPA, MU, YIELD_STRESS = 175e3, 80.77e3, 160.0


def steel(hardening: float) -> J2:
    """Steel with a hardening modulus in MPa; 0: perfect plasticity."""
    law = Linear(YIELD_STRESS, hardening) if hardening else Perfect(YIELD_STRESS)
    return J2(kappa=KAPPA, mu=MU, hardening=law)


@dataclass(frozen=True)
class Candidate:
    """What a sheet is made of through its thickness.

    Attributes
    ----------
    label : str
        Name in tables.
    variant : Variant
        Element.
    points, rule : int, str
        Thickness points of a layer and their rule.
    layers : int
        Elements through the thickness.
    """

    label: str
    variant: Variant
    points: int = 12
    rule: str = "split"
    layers: int = 1

    @property
    def nodes(self) -> int:
        """8 or 18."""
        return self.variant.element.nodes

    def strip(
        self,
        x: Floats,
        y: Floats,
        thickness: float,
        hardening: float,
        shape: Callable[[Floats], Floats] | None = None,
    ) -> Model:
        """Flat strip between the stations x and y, its mid-surface at z = 0; its nodes moved by a shape if wanted."""
        element = self.variant.element
        z = np.linspace(-0.5 * thickness, 0.5 * thickness, self.layers + 1)
        regular = mesh.grid(x, y, z, element.cell)
        return Model(
            regular if shape is None else regular.transformed(shape),
            element,
            material=steel(hardening),
            thickness_points=self.points,
            thickness_rule=self.rule,
        )


def of_order(name: str, order: int) -> Candidate:
    """An element with a thickness order: order 1 as in the literature, above it with E_33 tied."""
    kind = "8 nodes" if name == "ANS3DEAS" else "18 nodes"
    tied = order > 1
    return Candidate(f"order {order}, {kind}", Variant(name, {"thickness_order": order, "tie_E33": tied}))


def stack(name: str, layers: int, order: int, points: int = 4) -> Candidate:
    """Layers of an element: a continuum, the finer the more there are."""
    label = f"stack of {layers} {name}, order {order}"
    return Candidate(label, Variant(name, {"thickness_order": order, "tie_E33": True}), points, "gauss", layers)


BEND8 = Candidate("BEND8", Variant("BEND8"), rule="graded")
BEND18 = Candidate("BEND18", Variant("BEND18"), rule="graded")
