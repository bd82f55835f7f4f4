"""Thickness quadrature and order of E_33 of an element for a law."""

from __future__ import annotations

from umform.elements import at_order, at_order_by_column
from umform.elements.staggered import default_points
from umform.elements.technology import Element
from umform.materials.material import Material

#: Points of a plastic law where only another rule than the default is named.
_NAMED = 18


def points_through(element: Element, material: Material, points: int | None, rule: str | None) -> tuple[int, str]:
    """Points through the thickness and their rule: as given, else those of the law, else of the element for the law."""
    if points is not None:
        return points, rule or "gauss"
    least = element.thickness_order + 1
    if material.thickness_points is not None:
        return max(material.thickness_points, least), rule or "gauss"
    wanted, wanted_rule = element.plastic_rule if _plastic(material) else (2, "gauss")
    if "staggered" in (rule, wanted_rule) and rule != wanted_rule and rule is not None:
        wanted = default_points(element.surface_rule) if rule == "staggered" else _NAMED
    wanted, rule = max(wanted, least), rule or wanted_rule
    return wanted + wanted % 2 if rule == "staggered" else wanted, rule


def completed(element: Element, material: Material, points: int, rule: str) -> Element:
    """The element with the complete order of E_33, if the law is plastic. eq. (2.46)"""
    if points <= element.thickness_order + 1 or not (element.raised and _plastic(material)):
        return element
    return (at_order_by_column if rule == "staggered" else at_order)(element, points - 1)


def _plastic(material: Material) -> bool:
    """Whether the law has a history."""
    return len(material.law().initial()) > 0
