"""The rigid diaphragm of a shell of solid-shells, a support of the mid-surface and of the director."""

from __future__ import annotations

from umform.mesh import Selector
from umform.model import Model
from umform.model.supports.axes import cylindrical


def rigid_diaphragm(model: Model, edge: Selector) -> None:
    """Close the end of a cylinder about the y axis by a diaphragm that is rigid in its plane and free normal to it.

    In terms of a shell: no displacement of the mid-surface in the plane of the diaphragm, no rotation about the axis of
    the cylinder. So the mean of each pair of nodes is held in x and z, and their difference along the tangent of the
    ring; the director may tilt out of the plane, as the edge bends, and stretch.
    """
    model.hinge(edge, "xz")
    model.hold_director(edge, "t", axes=cylindrical((0.0, 0.0, 0.0), "y"))
