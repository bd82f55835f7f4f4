"""Elements as data: tying rules, enhanced modes, and the catalogue with the names of the literature."""

from umform.elements.catalogue import (
    ANS_SHEAR,
    ANS_THICKNESS,
    CATALOGUE,
    MITC9_IN_PLANE_SHEAR,
    MITC9_MEMBRANE,
    MITC9_SHEAR,
    element,
    membrane_modes,
    thickness_modes,
)
from umform.elements.complete_order import at_order, at_order_by_column, column_modes
from umform.elements.options import BodyOptions, ElementOptions
from umform.elements.rolling import Rolling, rolling_at, rolling_directions
from umform.elements.technology import COMPONENTS, Element, Mode, Polynomial, Tying
from umform.elements.through_thickness import thickness_rule

__all__ = [
    "ANS_SHEAR",
    "ANS_THICKNESS",
    "CATALOGUE",
    "COMPONENTS",
    "MITC9_IN_PLANE_SHEAR",
    "MITC9_MEMBRANE",
    "MITC9_SHEAR",
    "BodyOptions",
    "Element",
    "ElementOptions",
    "Mode",
    "Polynomial",
    "Rolling",
    "Tying",
    "at_order",
    "at_order_by_column",
    "column_modes",
    "element",
    "membrane_modes",
    "rolling_at",
    "rolling_directions",
    "thickness_modes",
    "thickness_rule",
]
