"""Settings of a contact of sheets: penalty from both sides, contact points, depth of the search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Le

from umform.errors import InvalidPenalty, InvalidValue
from umform.mesh import Ids, Mesh
from umform.model.contact.cells import MOST, refuse_points_and_cells
from umform.model.contact.encounter import Layer, bending_stress
from umform.model.contact.friction import AnyFriction, friction_kernel, refuse_slip_alone
from umform.model.contact.penalised import PenaltySettings
from umform.model.contact.settings import ALLOWED, POINTS
from umform.model.contact.sheets.faces import Depth, depth_of
from umform.spec import About, check_fields
from umform.spec.types import ContactPoints, Positive

#: Share of a sheet in the softness 1/penalty, in its thickness over its stiffness; and of a solid body, in the
#: thickness of its layer at the face over its stiffness: it deforms by more than a stiffer penalty would gain.
#: With multipliers, whose passes close a part of the gap that is the greater the stiffer the penalty, it stays.
_START, _LEAST, _MULTIPLIED, _SOLID = 50.0, 0.5, 5.0, 0.1
#: Deepest penetration that is one, in thicknesses of the thinner sheet, or in the reach of a solid body.
_DEEPEST = 0.5
_CELLS = About(cause="a number of cells in all", remedy="3 on 4-node and 5 on 9-node faces to begin with")


@dataclass(frozen=True)
class SheetContactOptions:
    """Choices of a contact of sheets; the rest follows from their thickness and their laws."""

    penalty: (
        Annotated[
            float,
            Gt(0.0),
            About(cause="a sign or a missing value", remedy="omit it", error=InvalidPenalty),
        ]
        | None
    ) = None
    """Penalty: contact pressure per penetration; by default a hundredth of the stiffness of both sheets across their
    thickness, which grows where the penetration exceeds the allowed one, or a tenth with multipliers, and ten times
    the stiffness of the layer at the face of a solid body, one of more than four layers. eq. (4.320)"""
    penetration: Positive | None = None
    """Allowed penetration; by default 1/200 of the thickness of the thinner sheet. A run that exceeds it warns."""
    augmented: bool = False
    """Remove excess penetration by multipliers, with a penalty that stays as it is. Costs a few iterations per
    increment. Sticking friction stays elastic."""
    points: ContactPoints | None = None
    """Gauss points per direction of a face, by default 2. Use at least 2 on 4-node and 3 on 9-node faces."""
    cells: Annotated[int, Ge(1), Le(MOST), _CELLS] | None = None
    """Cells per direction of a face in place of points, over which a linear gap is integrated up to the moving edge of
    contact. The tangent is unsymmetric."""
    friction: AnyFriction | None = None
    """Coefficient of friction, or a law; by default none. The tangent is unsymmetric."""
    slip: Positive | None = None
    """Elastic slip of a sticking point at the allowed penetration before it slips; by default 1/200 of the thickness of
    the thinner sheet."""

    def __post_init__(self) -> None:
        check_fields(self)
        refuse_points_and_cells(self.points, self.cells)
        refuse_slip_alone(self.friction, self.slip)


@dataclass(frozen=True, kw_only=True)
class SheetContactSettings(PenaltySettings):
    """Settings of a contact of sheets.

    Attributes
    ----------
    allowed : float
        Allowed penetration.
    points : int
        Gauss points, or cells, per direction and facet.
    over_cells : bool
        Whether these are cells.
    thickness, reach : float
        Those of the thinner sheet.
    stiffness : float
        Traction per elastic slip; zero without friction.
    """

    allowed: float
    points: int
    over_cells: bool
    thickness: float
    reach: float
    stiffness: float = 0.0

    @property
    def deepest(self) -> float:
        """Penetration beyond which a place belongs to no contact."""
        return _DEEPEST * self.reach


def sheet_contact_settings(
    mesh: Mesh, sides: Sequence[Ids], layers: Sequence[Layer], options: SheetContactOptions, where: str
) -> SheetContactSettings:
    """Settings from the given values, the rest from the sheets; the same whichever side comes first. eq. (4.320)

    Parameters
    ----------
    mesh : Mesh
        The sheets.
    sides : sequence of ndarray of int, shape (k, 2)
        Faces of each side, rows (cell, face).
    layers : sequence of Layer
        Layer at the face of each side.
    options : SheetContactOptions
        The given values.
    where : str
        For messages.

    Raises
    ------
    InvalidValue
        If a penetration is allowed that is no contact any more.
    """
    depths = [depth_of(mesh, side) for side in sides]
    thinner, reach = min(depth.thickness for depth in depths), min(depth.reach for depth in depths)
    allowed = ALLOWED * thinner if options.penetration is None else float(options.penetration)
    if allowed > _DEEPEST * reach:
        raise InvalidValue(
            "the allowed penetration must be a small part of the thickness",
            where=f"{where}, penetration",
            value=allowed,
            cause=f"another unit; beyond {_DEEPEST * reach:g} a sheet has gone through the other one",
            remedy=f"omit it: {ALLOWED * thinner:g}, 1/{1 / ALLOWED:g} of the thickness, is allowed then",
        )
    penalty, largest = options.penalty, 0.0
    if penalty is None:
        stiff = [bending_stress(layer.material, 1e-7, where) / 1e-7 for layer in layers]
        deep = [layer.thickness or depth.thickness for layer, depth in zip(layers, depths, strict=True)]
        penalty, largest = (
            0.5 * len(depths) / sum(map(partial(_softness, share), depths, deep, stiff))
            for share in ((_MULTIPLIED if options.augmented else _START), _LEAST)
        )
        largest = 0.0 if options.augmented else largest
    over_cells = options.cells is not None
    points = options.cells or options.points or POINTS
    stiffness, friction = 0.0, options.friction
    if isinstance(friction, int | float) and friction == 0:
        friction = None
    if friction is not None:
        slip = ALLOWED * thinner if options.slip is None else float(options.slip)
        pressure = penalty * allowed
        bound = friction_kernel(friction).bound(pressure)[0]
        stiffness = (bound if bound > 0.0 else pressure) / slip
    return SheetContactSettings(
        penalty=float(penalty),
        allowed=allowed,
        points=int(points),
        over_cells=over_cells,
        thickness=thinner,
        reach=reach,
        friction=friction,
        stiffness=float(stiffness),
        largest=float(largest),
        augmented=bool(options.augmented),
    )


def _softness(of_sheet: float, depth: Depth, thickness: float, stiffness: float) -> float:
    """Share of a body in 1/penalty, with the thickness of the metal of this stiffness at its face. eq. (4.320)"""
    return (_SOLID * depth.layer if depth.solid else of_sheet * thickness) / stiffness


def longest_side(mesh: Mesh, facets: Ids) -> float:
    """Longest side of facets (k, 4 or 9)."""
    corners = mesh.points[facets[:, :4]]
    return float(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=-1).max())
