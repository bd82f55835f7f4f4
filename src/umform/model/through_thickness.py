"""Thickness quadrature and order of E_33 of an element for a law."""

from __future__ import annotations

from umform.elements import at_order
from umform.elements.technology import Element
from umform.materials.material import Material


def points_through(element: Element, material: Material, points: int | None, rule: str | None) -> tuple[int, str]:
    """Points through the thickness and their rule: as given, else the default of law and element."""
    wanted, wanted_rule = element.plastic_points if _plastic(material) else (2, "gauss")
    if points is not None:
        return points, rule or "gauss"
    return max(wanted, material.thickness_points, element.thickness_order + 1), rule or wanted_rule


def completed(element: Element, material: Material, points: int) -> Element:
    """The element with the complete order of E_33, if the law is plastic. eq. (2.46)"""
    if not (_plastic(material) and element.complete) or points <= element.thickness_order + 1:
        return element
    return at_order(element, points - 1)


def _plastic(material: Material) -> bool:
    return material.thickness_points > 2
