"""Complete order of E_33 through the thickness, of elements of the catalogue and of the user's own."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from umform import _core
from umform.elements.catalogue import thickness_modes
from umform.elements.plane_strain import uniform_modes
from umform.elements.technology import Element, Mode


def at_order(made: Element, order: int) -> Element:
    """An element whose enhanced thickness strain is complete up to an order in t. eq. (2.46)

    Other modes stay. Where those of E_33 are a list of the catalogue, the list of that order takes their place. To
    other modes of E_33, all P_1 ... P_order are added that they do not span at the Gauss points.

    Parameters
    ----------
    made : Element
        The element.
    order : int
        Highest Legendre polynomial in t, 1 to 19.

    Examples
    --------
    >>> import umform as uf
    >>> own = uf.Element("own", "hex8", modes=((uf.Term("12", 1),), (uf.Term("33", c=1),)))
    >>> [mode[0].c for mode in uf.elements.at_order(own, 4).modes]
    [0, 1, 2, 3, 4]
    """
    changed = _exchanged(made, order) or {"modes": made.modes + _missing(made, order)}
    return replace(made, thickness_order=order, complete=False, **changed)


def _exchanged(made: Element, order: int) -> dict[str, Any] | None:
    """Modes and options with the list of another order; None if the modes of E_33 are not one of the catalogue."""
    options: dict[str, Any] = made.options
    if not options.get("thickness_modes"):
        return None
    listed = _listed(made, options["thickness_order"])
    at = next((k for k in range(len(made.modes)) if made.modes[k : k + len(listed)] == listed), None)
    if at is None:
        return None
    before, after = made.modes[:at], made.modes[at + len(listed) :]
    if any(term.component == "33" for mode in before + after for term in mode):
        return None
    modes = before + _listed(made, order) + after
    return {"modes": modes, "options": options | {"thickness_order": order}}


def _listed(made: Element, order: int) -> tuple[Mode, ...]:
    """Modes of E_33 of an element of the catalogue up to an order."""
    options: dict[str, Any] = made.options
    modes = thickness_modes(options["thickness_modes"], order, options["order_modes"])
    return uniform_modes(modes) if made.plane_strain else modes


def _missing(made: Element, order: int) -> tuple[Mode, ...]:
    """Modes of the complete order, constant in the surface of 8 nodes, that those of an element do not span."""
    count = 9 if made.cell == "hex18" and made.surface_rule == (3, 3) else 1
    t, w = _core.gauss(max(order, made.thickness_order) + 1)
    full = replace(made, modes=made.modes + thickness_modes(count, order, count), thickness_order=0)
    values = full.mode_values(t, w)
    own = len(made.modes)
    basis = list(np.linalg.qr(values[:, :own])[0].T)
    missing: list[Mode] = []
    for mode, value in zip(full.modes[own:], values[:, own:].T, strict=True):
        rest = value - sum((q * (q @ value) for q in basis), np.zeros_like(value))
        if np.linalg.norm(rest) > 1e-8 * np.linalg.norm(value):
            basis.append(rest / np.linalg.norm(rest))
            missing.append(mode)
    return tuple(missing)
