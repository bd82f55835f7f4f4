"""The catalogue of elements, with the names of the literature: tying rules and enhanced modes.

An element is data. A tying rule is a list of :class:`Tying` rows (docs/theory, eq. (2.2)), an enhancement a list of
modes (:class:`Mode`, eq. (2.10)); the kernels need nothing else. A new element is a few rows here, or in
the user's own script: ``Element("MINE", "hex8", tying=(...), modes=(...))``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypedDict

from umform.elements.options import ElementOptions
from umform.elements.plane_strain import in_plane_strain
from umform.elements.technology import Element, Mode, Polynomial, Tying
from umform.elements.through_thickness import MOST_POINTS
from umform.errors import InvalidValue
from umform.spec import takes

_A = 1.0 / math.sqrt(3.0)
_B = math.sqrt(3.0 / 5.0)


# Tying rules -------------------------------------------------------------------------------------------------

#: Bathe & Dvorkin (1985): transverse shear tied at the middles of the edges of the mid-surface.
ANS_SHEAR = (Tying("13", (0.0,), (-1.0, 1.0)), Tying("23", (-1.0, 1.0), (0.0,)))

#: Bucalem & Bathe (1993): in-plane and transverse shear strains tied layer by layer.
MITC9_MEMBRANE = (
    Tying("11", (-_A, _A), (-_B, 0.0, _B), at_layer=True),
    Tying("22", (-_B, 0.0, _B), (-_A, _A), at_layer=True),
)
MITC9_IN_PLANE_SHEAR = (Tying("12", (-_A, _A), (-_A, _A), at_layer=True),)
MITC9_SHEAR = (
    Tying("13", (-_A, _A), (-_B, 0.0, _B), at_layer=True),
    Tying("23", (-_B, 0.0, _B), (-_A, _A), at_layer=True),
)

#: Betsch & Stein (1995): thickness strain tied at the corners, and its biquadratic extension at the nine nodes.
ANS_THICKNESS = {
    "hex8": (Tying("33", (-1.0, 1.0), (-1.0, 1.0)),),
    "hex18": (Tying("33", (-1.0, 0.0, 1.0), (-1.0, 0.0, 1.0)),),
}

# Enhanced modes ----------------------------------------------------------------------------------------------


def _nodal(component: str, order: int) -> dict[tuple[int, int], Mode]:
    """Products of P_order(t) with the nine Lagrange polynomials of the 3 x 3 Gauss points, in their order."""
    half, square = 0.5 / _B, 0.5 / _B**2
    of_point = (((1, -half), (2, square)), ((0, 1.0), (2, -2.0 * square)), ((1, half), (2, square)))
    return {
        (i, j): Mode.of(
            Polynomial(component, a, b, order, factor=f * g) for b, g in of_point[j] for a, f in of_point[i]
        )
        for j in range(3)
        for i in range(3)
    }


def thickness_modes(count: int, order: int, order_count: int = 1) -> tuple[Mode, ...]:
    """Modes of E_33: t times 1, 4 or 9 polynomials in the surface, then P_2(t) ... P_order(t) times as many again.

    Nine span all biquadratic polynomials. They are the Lagrange polynomials of the Gauss points: each mode is zero at
    all points of the surface but one, so that the parameters of different points are eliminated separately.

    Parameters
    ----------
    count : {0, 1, 4, 9}
        Number of modes linear in t: Büchter, Ramm & Roehl (1994) for one; {1, r, s, rs} let the distorted bending patch
        test pass; nine are the full biquadratic set.
    order : int
        Highest Legendre polynomial in t, 1 to 19.
    order_count : {1, 4, 9}
        Number of polynomials in the surface for each of P_2 ... P_order. One is enough for 8 nodes, where more have no
        measurable effect; 18 nodes need nine in a sharp bend (docs/theory, 2.8).
    """
    if order_count not in (1, 4, 9):
        raise InvalidValue(
            "the number of modes of higher order must be 1, 4 or 9",
            where="order_count",
            value=order_count,
            cause="a number of nodes or of points",
            remedy="1, 4 or 9",
        )
    if count not in (0, 1, 4, 9):
        raise InvalidValue(
            "the number of thickness modes must be 0, 1, 4 or 9",
            where="thickness_modes",
            value=count,
            cause="a number of nodes or of points",
            remedy="0 leaves the enhanced thickness strain out",
        )
    if order not in range(1, MOST_POINTS):
        raise InvalidValue(
            f"the thickness order must be 1 to {MOST_POINTS - 1}",
            where="thickness_order",
            value=order,
            cause="a number of points in place of the degree of the strain",
            remedy="1, or 2 and 3 for sharp bends",
        )
    counts = {1: count} | dict.fromkeys(range(2, order + 1), order_count)
    few: tuple[Mode, ...] = tuple(
        Mode("33", a, b, p)
        for p, modes in counts.items()
        if modes < 9
        for b in range(math.isqrt(modes))
        for a in range(math.isqrt(modes))
    )
    nine = [_nodal("33", p) for p, modes in counts.items() if modes == 9]
    return few + tuple(of_order[point] for point in (nine[0] if nine else ()) for of_order in nine)


def membrane_modes(count: int) -> tuple[Mode, ...]:
    """Modes of the in-plane strains: 4 or 5 (Simo & Rifai 1990), or 7 (Andelfinger & Ramm 1993)."""
    four = (Mode("11", 1), Mode("22", 0, 1), Mode("12", 1), Mode("12", 0, 1))
    coupled = Mode("11", 1, 1) + Mode("22", 1, 1, factor=-1.0) + Mode("12", 2) + Mode("12", 0, 2, factor=-1.0)
    modes: dict[int, tuple[Mode, ...]] = {
        0: (),
        4: four,
        5: (*four, coupled),
        7: (*four, Mode("11", 1, 1), Mode("22", 1, 1), Mode("12", 1, 1)),
    }
    if count not in modes:
        raise InvalidValue(
            "the number of membrane modes must be 0, 4, 5 or 7",
            where="membrane_modes",
            value=count,
            cause="a number of nodes or of points",
            remedy="0 leaves the enhanced membrane strain out",
        )
    return modes[count]


class _Bends(TypedDict):
    order: int
    tied: bool


# Elements ----------------------------------------------------------------------------------------------------


def _build(
    name: str,
    cell: str,
    tying: tuple[Tying, ...],
    citation: str,
    *,
    thickness: int,
    membrane: int = 0,
    order: int = 1,
    tied: bool = False,
) -> Callable[..., Element]:
    """Element factory; its keyword arguments are the options that the literature leaves open."""

    def make(
        thickness_modes_count: int = thickness,
        thickness_order: int | None = None,
        order_modes_count: int = 9 if cell == "hex18" else 1,
        membrane_modes_count: int = membrane,
        tie_E33: bool = tied,
        compatible_E12: bool = False,
        plane_strain: bool = False,
    ) -> Element:
        complete = thickness > 0 and thickness_order is None
        thickness_order = order if thickness_order is None else thickness_order
        _check_thickness(name, cell, thickness, thickness_modes_count, thickness_order, order_modes_count)
        if membrane == 0 and membrane_modes_count != 0:
            raise InvalidValue(f"{name} has no enhanced membrane strain", remedy="take EAS3DEAS")
        if membrane > 0 and membrane_modes_count not in (4, 5, 7):
            raise InvalidValue(
                "the number of membrane modes must be 4, 5 or 7",
                where="membrane_modes",
                value=membrane_modes_count,
                cause="a number of nodes or of points",
                remedy="leave it out, or take one of these",
            )
        rows = tuple(row for row in tying if not (compatible_E12 and row.component == "12"))
        modes = membrane_modes(membrane_modes_count)
        if thickness > 0:
            modes += thickness_modes(thickness_modes_count, thickness_order, order_modes_count)
        made = Element(
            name=name,
            cell=cell,
            tying=rows + (ANS_THICKNESS[cell] if tie_E33 else ()),
            modes=modes,
            surface_points=2 if cell == "hex8" else 3,
            thickness_order=thickness_order if thickness > 0 else 0,
            citation=citation,
            complete=complete,
            options={
                "thickness_modes": thickness_modes_count,
                "thickness_order": thickness_order,
                "order_modes": order_modes_count,
                "membrane_modes": membrane_modes_count,
                "tie_E33": tie_E33,
                "compatible_E12": compatible_E12,
            },
        )
        return in_plane_strain(made) if plane_strain else made

    return make


def _check_thickness(name: str, cell: str, thickness: int, count: int, order: int, order_count: int) -> None:
    """Reject thickness modes for an element whose modes already include thickness strains."""
    if thickness == 0 and (count != 0 or order != 1):
        raise InvalidValue(
            f"{name} has no enhanced thickness strain",
            value=f"thickness_order={order}, thickness_modes={count}",
            remedy="take one of the elements with EAS in their name"
            if cell == "hex8"
            else "take DISP9K3DEAS or MI9K3DEAS",
        )
    if thickness > 0 and count not in (1, 4, 9):
        raise InvalidValue(
            "the number of thickness modes must be 1, 4 or 9",
            where="thickness_modes",
            value=count,
            cause="a number of nodes or of points",
            remedy="leave it out, or take one of these",
        )
    if 9 in (count, order_count) and cell == "hex8":
        raise InvalidValue(
            f"{name} cannot tell nine thickness modes apart",
            value=9,
            cause="at 2 x 2 Gauss points r² and s² are constants",
            remedy="take 4, or an element with 18 nodes",
        )


_MITC9 = MITC9_MEMBRANE + MITC9_IN_PLANE_SHEAR + MITC9_SHEAR

#: What sharp bends need, of an elastic law too.
_BENDS: _Bends = {"order": 4, "tied": True}

#: The catalogue: name -> factory.
CATALOGUE: dict[str, Callable[..., Element]] = {
    "DISP3D": _build("DISP3D", "hex8", (), "HauptmannSchweizerhof1998", thickness=0),
    "DISP3DEAS": _build("DISP3DEAS", "hex8", (), "HauptmannSchweizerhof1998", thickness=4),
    "ANS3DEAS": _build("ANS3DEAS", "hex8", ANS_SHEAR, "HauptmannSchweizerhof1998", thickness=4),
    "EAS3DEAS": _build("EAS3DEAS", "hex8", ANS_SHEAR, "HarnauSchweizerhof2002", thickness=4, membrane=7),
    "DISP9K3D": _build("DISP9K3D", "hex18", (), "HauptmannEtAl2001", thickness=0),
    "DISP9K3DEAS": _build("DISP9K3DEAS", "hex18", (), "HauptmannEtAl2001", thickness=9),
    "MI9K3DEAS": _build("MI9K3DEAS", "hex18", _MITC9, "HauptmannEtAl2001", thickness=9),
    # For sharp bends (docs/theory, 2.8): ANS3DEAS and MI9K3DEAS at order 4, with E_33 tied.
    "BEND8": _build("BEND8", "hex8", ANS_SHEAR, "HauptmannSchweizerhof1998", thickness=4, **_BENDS),
    "BEND18": _build("BEND18", "hex18", _MITC9, "HauptmannEtAl2001", thickness=9, **_BENDS),
}


@takes(ElementOptions)
def element(name: str | Element, **options: Any) -> Element:
    """An element of the catalogue.

    Parameters
    ----------
    name : str or Element
        A name of :data:`CATALOGUE`, or your own element (then without options).
    **options
        Fields of :class:`umform.elements.ElementOptions`.

    Raises
    ------
    InvalidValue
        If the name is unknown or the element has no such option.
    """
    given = ElementOptions(**options).of_element()
    if isinstance(name, Element):
        if given:
            raise InvalidValue(
                "an Element takes no further options", value=sorted(given), remedy="set them where you build it"
            )
        return name
    if name not in CATALOGUE:
        raise InvalidValue(
            "unknown element",
            where="element",
            value=name,
            cause="a typing mistake, or a name of another program",
            remedy="one of " + ", ".join(CATALOGUE),
        )
    if given.get("compatible_E12") and name not in ("MI9K3DEAS", "BEND18"):
        raise InvalidValue(f"{name} does not tie E_12", remedy="leave compatible_E12 out, or take MI9K3DEAS or BEND18")
    return CATALOGUE[name](**{f"{key}_count" if key.endswith("modes") else key: value for key, value in given.items()})


__all__ = [
    "CATALOGUE",
    "Element",
    "Mode",
    "Tying",
    "element",
    "membrane_modes",
    "thickness_modes",
]
