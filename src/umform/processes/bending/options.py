"""Mesh and contact rule of free bending as they are typed."""

from __future__ import annotations

from umform.errors import InvalidValue
from umform.processes.bending.spec import ContactRule


def read_mesh(text: str) -> tuple[int, int]:
    """The mesh that is written as 24x1."""
    along, _, across = text.lower().partition("x")
    if not (_is_count(along) and _is_count(across)):
        raise InvalidValue(
            "this is no mesh",
            where="mesh",
            value=repr(text),
            cause="a mesh is two whole numbers with an x between them",
            remedy="write the elements along and across the strip, such as 24x1",
        )
    return int(along), int(across)


def read_contact(text: str) -> ContactRule:
    """The contact rule that is written as nodes, 5 or 5x5."""
    first, _, second = text.lower().partition("x")
    if text.lower() == "nodes":
        return "nodes"
    if not _is_count(first) or (second or first) != first or text.lower().endswith("x"):
        raise InvalidValue(
            "this is no contact rule",
            where="contact",
            value=repr(text),
            cause="the points are as many in one direction of a facet as in the other",
            remedy="write nodes, or points per direction such as 5",
        )
    return int(first)


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdecimal()
