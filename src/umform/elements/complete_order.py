"""Complete order of E_33 through the thickness, of elements of the catalogue and of the user's own."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from umform import _core
from umform.elements.catalogue import thickness_modes
from umform.elements.plane_strain import uniform_modes
from umform.elements.technology import Element, Mode, Polynomial


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
    >>> own = uf.Element("own", "hex8", modes=(uf.Mode("12", 1), uf.Mode("33", c=1)))
    >>> [mode.polynomials[0].c for mode in uf.elements.at_order(own, 4).modes]
    [0, 1, 2, 3, 4]
    """
    changed = _exchanged(made, order) or {"modes": made.modes + _missing(made, order)}
    return replace(made, thickness_order=order, complete=False, **changed)


def at_order_by_column(made: Element, order: int) -> Element:
    """An element whose thickness strain is complete up to an order in t at each column of points by itself.

    Columns with heights of their own share no mode: those of a column are zero at all others, and are eliminated by
    themselves. They span all other modes of E_33 that vary through the thickness. eq. (2.46)

    Parameters
    ----------
    made : Element
        The element.
    order : int
        Highest Legendre polynomial in t, 1 to 19.
    """
    others = tuple(
        mode for mode in made.modes if any(part.component != "33" or part.c == 0 for part in mode.polynomials)
    )
    modes = others + column_modes(made.surface_rule, order)
    return replace(made, thickness_order=order, complete=False, modes=modes)


def column_modes(surface: tuple[int, int], order: int) -> tuple[Mode, ...]:
    """P_1(t) ... P_order(t) of E_33, each times the Lagrange polynomials of the Gauss points of the surface."""
    along, across = (_lagrange(count) for count in surface)
    return tuple(
        Mode.of(
            Polynomial("33", a, b, p, factor=float(f * g))
            for b, g in enumerate(of_s)
            for a, f in enumerate(of_r)
            if f * g != 0.0
        )
        for of_s in across
        for of_r in along
        for p in range(1, order + 1)
    )


def _lagrange(count: int) -> np.ndarray:
    """Coefficients of the Lagrange polynomials of as many Gauss points, a row for each."""
    values = np.vander(_core.gauss(count)[0], increasing=True)
    coefficients = np.linalg.inv(values).T
    return np.where(np.abs(coefficients) > 1e-14, coefficients, 0.0)


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
    if any(part.component == "33" for mode in before + after for part in mode.polynomials):
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
