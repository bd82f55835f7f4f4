"""Planes of symmetry of a model, and the whole part from a modelled half or quarter."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.results.shape import Shape

Floats = NDArray[np.float64]

#: Distance of nodes from a plane that counts as zero, as a part of the size of the sheet.
_HAIR = 1e-7
#: Difference of distances that counts as zero, as a part of the size of the sheet.
_SAME = 1e-6
#: Points along each side of a box in which a tool is compared with its mirror image.
_SAMPLES = 7


@dataclass(frozen=True)
class Mirror:
    """A plane of symmetry across a coordinate axis.

    Attributes
    ----------
    axis : int
        Its normal: 0, 1 or 2.
    at : float
        Its coordinate.
    """

    axis: int
    at: float

    def image(self, x: Floats) -> Floats:
        """Mirror images of positions (..., 3)."""
        image = x.copy()
        image[..., self.axis] = 2.0 * self.at - x[..., self.axis]
        return image


def mirrors(model: Model) -> list[Mirror]:
    """Planes of symmetry according to the supports of a model, where they are now, at most one for each axis.

    A plane counts if the sheet ends there through its whole thickness, supports hold all nodes in it across it, and not
    all of them are held in every direction, which is a clamp; an edge that a control moves does not count. Nodes that
    are all held along an axis, as in plane strain, do not count.

    Parameters
    ----------
    model : Model
        The model.
    """
    return [now for _, now in _planes(model)]


def mirrors_of_blank(model: Model) -> list[Mirror]:
    """The same planes where they are in the undeformed mesh: elsewhere in a part that was moved into other tools."""
    return [before for before, _ in _planes(model)]


def _planes(model: Model) -> Iterator[tuple[Mirror, Mirror]]:
    """The planes of symmetry in the undeformed mesh, and now."""
    points, now, held = model.mesh.points, model.positions, model.supports.constrained().reshape(-1, 3)
    fixed = model.supports.fixed.reshape(-1, 3) & ~held.all(axis=0)
    hair = _HAIR * float(np.ptp(points, axis=0).max())
    for axis in range(3):
        x = points[:, axis]
        for at in (float(x.min()), float(x.max())):
            inside = np.abs(x - at) <= hair
            if held[inside].all() or not _through_the_thickness(model, inside):
                continue
            flat = fixed[inside].all(axis=0) & (np.ptp(now[inside], axis=0) <= hair)
            if flat.any():
                across = axis if flat[axis] else int(np.argmax(flat))
                yield Mirror(axis, at + 0.0), Mirror(across, float(now[inside, across].min()) + 0.0)
                break


def modelled_part(model: Model) -> str:
    """What forces and works refer to if planes of symmetry leave only a part in the model; otherwise empty."""
    count = len(mirrors(model))
    if not count:
        return ""
    part = {1: "half", 2: "a quarter", 3: "an eighth"}[count]
    return (
        f"{part} of the sheet is computed, by symmetry: forces and works of the whole are {2**count} times those here"
    )


def _through_the_thickness(model: Model, inside: NDArray[np.bool_]) -> bool:
    """Whether for each pair of a lower and an upper node both lie in a plane, or neither."""
    lower, upper = np.split(model.mesh.connectivity, 2, axis=1)
    return bool((inside[lower] == inside[upper]).all())


def whole(shape: Shape, planes: Sequence[Mirror]) -> Shape:
    """A shape together with its mirror images."""
    for plane in planes:
        shift = np.zeros(3)
        shift[plane.axis] = plane.at
        shape = replace(shape, points=shape.points - shift).mirrored(plane.axis)
        shape = replace(shape, points=shape.points + shift)
    return shape


def with_images(x: Floats, planes: Sequence[Mirror]) -> Floats:
    """Positions (n, 3) and behind them their mirror images: those of the whole part."""
    for plane in planes:
        x = np.concatenate([x, plane.image(x)])
    return x


def is_symmetric(gap: Callable[[Floats], Floats], plane: Mirror, box: tuple[Floats, Floats]) -> bool:
    """Whether a tool is its own mirror image.

    Parameters
    ----------
    gap : callable
        Signed distances of positions (n, 3) to the tool.
    plane : Mirror
        The plane.
    box : tuple of ndarray
        Lowest and highest corner of a box, in which the distances are compared.
    """
    sides = [np.linspace(low, high, _SAMPLES) for low, high in zip(*box, strict=True)]
    x = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3)
    here, there = gap(x), gap(plane.image(x))
    size = float(np.linalg.norm(box[1] - box[0]))
    return bool(np.allclose(here, there, rtol=0.0, atol=_SAME * size, equal_nan=True))
