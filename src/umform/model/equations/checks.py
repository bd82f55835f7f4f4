"""Reject models that cannot be solved, before the run starts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from umform.errors import ModelError, RigidBodyMotion, ToolSwallowsSheet
from umform.mesh import Ids, Mesh
from umform.mesh.numbers import median
from umform.model.contact import Contact, ContactFound
from umform.model.equations.evaluated import Evaluated
from umform.model.equations.evaluation import Evaluation
from umform.model.equations.plane_strain_check import check_plane_strain
from umform.model.supports.support import Support
from umform.model.terms import forces
from umform.model.terms.term import At

Floats = NDArray[np.float64]


def check_model(model: Evaluated, gauge: Support | None = None) -> None:
    """Check nodes, supports and tools.

    Parameters
    ----------
    model : Model
        The model.
    gauge : Support, optional
        A waiting support that the first step puts in place: a part that no tool touches any more is opened on it.

    Raises
    ------
    RigidBodyMotion
        If supports and touching tools leave a rigid-body motion free, or a node belongs to no cell.
    ToolSwallowsSheet
        If a tool overlaps the sheet by more than half of its thickness.
    ModelError
        If a body in plane strain may move across.
    """
    check_nodes(model.mesh)
    check_plane_strain(model)
    check_held(model, gauge)


def check_nodes(mesh: Mesh) -> None:
    """Reject nodes without a cell."""
    used = np.zeros(len(mesh.points), dtype=bool)
    used[mesh.connectivity] = True
    unused = np.flatnonzero(~used)
    if len(unused):
        raise RigidBodyMotion(
            "a node belongs to no cell, so nothing holds it",
            where=f"node {unused[0]} (one of {len(unused)})",
            cause="left over from a mesh generator",
            remedy="take unused nodes out of the mesh; umform.mesh.read does so",
        )


def middle(model: Evaluated, points: Floats | None = None) -> tuple[Floats, float]:
    """Mean of the nodes of the undeformed mesh, or of other points, and the largest distance from it along an axis."""
    points, ranks = model.mesh.points if points is None else points, model.ranks
    centre = ranks.sum(points.sum(axis=0)) / ranks.sum(float(len(points)))
    return centre, max(ranks.max(float(np.abs(points - centre).max())), 1e-300)


def check_held(model: Evaluated, gauge: Support | None = None) -> None:
    """Reject supports that leave a rigid-body motion free, and tools that overlap the sheet too much."""
    problem = None
    try:
        touched = [*_touching(model), *sprung(model)]
    except ModelError as error:
        touched, problem = [], error
    model.ranks.agree(problem)
    free = free_motions(model, touched, () if gauge is None else gauge.held)
    if free:
        for_good = free_in_touch(model)
        raise RigidBodyMotion(
            f"the sheet can move as a rigid whole in {len(free)} way{'s' if len(free) > 1 else ''}",
            value="free: " + "; ".join(free),
            cause="too few supports: tools that touch would leave free " + "; ".join(for_good)
            if for_good
            else "a tool that does not touch the sheet yet, and that no step moves, or springs that are switched off",
            remedy="hold the sheet with fix(), symmetry(), hinge() or prescribe(), let a tool overlap it by a hair, "
            "or rest() it on springs until tools hold it",
        )


def free_now(model: Evaluated) -> list[str]:
    """Rigid-body motions that supports, touching tools and springs leave free at the present state, as text.

    Raises
    ------
    ToolSwallowsSheet
        If a tool overlaps the sheet by more than half of its thickness.
    """
    return free_motions(model, [*_touching(model), *sprung(model)])


def free_in_touch(model: Evaluated) -> list[str]:
    """Rigid-body motions that would be free if all contact points touched, as text."""
    pairs = [pair for pair in model.contacts if len(pair.facets) > 0 and not pair.tool.open]
    held = []
    for pair in pairs:
        at = pair.locate(model.u, pair.pose)
        known = np.isfinite(at.normal).all(axis=1)
        held += _directions(pair, at.x[known], at.normal[known])
    return free_motions(model, [*held, *sprung(model)])


def free_motions(
    model: Evaluated, touched: Sequence[tuple[Floats, Floats]] = (), dofs: Sequence[int] | Ids = ()
) -> list[str]:
    """Rigid-body motions that supports and tools leave free at the present displacement of the model, as text.

    Parameters
    ----------
    model : Model
        The model at ``model.u``.
    touched : sequence of (positions, normals)
        Points held by tools, and the directions in which they are held.
    dofs : sequence of int
        More degrees of freedom that are held.
    """
    points = model.mesh.displaced(model.u)
    centre, size = middle(model, points)
    modes = forces.rigid_body_modes(points, centre, size)
    rows = [motion_along(x, n, centre, size) for x, n in touched]
    rows.append(modes[:, np.asarray(dofs, dtype=int)].T)
    return [_describe_motion(motion) for motion in left_free(model, modes, rows)]


def left_free(model: Evaluated, modes: Floats, more: Sequence[Floats] = ()) -> Floats:
    """Combinations (k, 6) of the rigid-body modes (6, 3 n) that supports and more rows (m, 6) leave free."""
    rows = [modes[:, np.flatnonzero(model.supports.constrained())].T]
    rows += [modes[:, tie.dofs].mean(axis=-1).T for tie in model.supports.ties]
    rows += [np.einsum("mkd,kd->km", modes[:, part.dofs], part.weights) for part in model.supports.rows]
    matrix = model.ranks.rows(np.concatenate([np.zeros((6, 6)), *rows, *more]))  # six rows give all six directions
    _, singular, directions = np.linalg.svd(matrix, full_matrices=False)
    rank = int((singular > 1e-8 * max(singular.max(), 1e-300)).sum())
    return np.asarray(directions[rank:])


def diagnosis(model: Evaluated) -> tuple[str, str] | None:
    """Cause and remedy if a rigid-body motion of the model is free at its present state, or constrained by tools only.

    Used after a failed increment; None if supports hold the sheet.
    """
    without = free_motions(model, list(sprung(model)))
    if not without:
        return None
    try:
        free = free_motions(model, [*_in_touch(model), *sprung(model)])
    except ModelError:
        free = without
    hold = "hold it there with fix(), symmetry() or hinge() (three points hold a sheet), or take the step in reverse"
    if free:
        return f"nothing holds the sheet: {'; '.join(free)} free", hold
    return (
        f"tools alone hold the sheet against {'; '.join(without)}, and let it go in this increment",
        f"{hold}, or stop the tool while it still touches",
    )


def held_by_tools(model: Evaluated, evaluation: Evaluation) -> bool:
    """Whether tools and supports hold the sheet as a rigid body: along normals, and where friction sticks, fully."""
    touched = []
    for contact in model.contacts:
        found = evaluation.found[contact]
        touched.append((found.held.x, found.held.normal))
        if contact.friction is not None:
            sticks = found.held.x[found.status[found.held.points] == 1]
            touched += [(sticks, np.tile(axis, (len(sticks), 1))) for axis in np.eye(3)]
    return not free_motions(model, touched)


def _in_touch(model: Evaluated) -> Iterator[tuple[Floats, Floats]]:
    """Positions and normals of the points that each tool holds at the present state."""
    for contact in model.contacts:
        if len(contact.facets) > 0:
            yield from _held_by(contact, contact.locate(model.u, contact.pose))


def sprung(model: Evaluated) -> Iterator[tuple[Floats, Floats]]:
    """Positions of the nodes that terms hold at the present state, foundations for instance, and the directions."""
    x = model.mesh.displaced(model.u)
    at = At(model.u, model.time, {control: control.value for control in model.controls})
    for term in model.others:
        held = term.holds(at)
        if held is not None:
            nodes, directions = held
            yield x[nodes], directions


def _touching(model: Evaluated) -> Iterator[tuple[Floats, Floats]]:
    """Positions and normals of the points that each tool holds; a tool that swallows the sheet is refused."""
    mesh = model.mesh
    half = len(mesh.connectivity[0]) // 2
    directors = mesh.points[mesh.connectivity[:, half:]] - mesh.points[mesh.connectivity[:, :half]]
    thickness = median(np.linalg.norm(directors, axis=-1))
    for contact in model.contacts:
        if len(contact.facets) == 0 or contact.tool.open:
            continue
        at = contact.locate(model.u, contact.pose)
        undefined = ~(np.isfinite(at.gap) & np.isfinite(at.normal).all(axis=1))
        if undefined.any():
            raise ToolSwallowsSheet(
                "the gap to a tool has no normal at a contact point",
                where=f"contact {contact.name}, x = {np.round(at.x[undefined][0], 6)}",
                cause="the point lies on the axis or the centre of the tool",
                remedy="move the tool so that it just touches the sheet",
            )
        gap = contact.gap(mesh.displaced(model.u)[contact.nodes])  # the far face has the wrong sign
        deepest = int(np.argmin(gap))
        if gap[deepest] < -0.5 * thickness and not contact.has_begun:  # chords of a formed sheet overlap a radius
            raise ToolSwallowsSheet(
                "a tool overlaps the sheet before anything has moved",
                where=f"contact {contact.name}, node {model.whole.node_number(contact.nodes[deepest])}",
                value=f"gap {gap[deepest]:.4g}, thickness {thickness:.4g}",
                cause="the tool stands on the wrong side, a normal points into the sheet, or units differ",
                remedy="move the tool so that it just touches the sheet, or turn its normal",
            )
        yield from _held_by(contact, at)


def _held_by(contact: Contact, at: ContactFound) -> Iterator[tuple[Floats, Floats]]:
    """Positions of the points that a tool holds, and the directions of the constraint."""
    yield from _directions(contact, at.x[at.active], at.normal[at.active])


def _directions(contact: Contact, x: Floats, normals: Floats) -> list[tuple[Floats, Floats]]:
    """Points of a tool with the directions of the constraint: the normals, with friction all directions."""
    if contact.friction is None:
        return [(x, normals)]
    return [(x, np.broadcast_to(direction, x.shape)) for direction in np.eye(3)]


def motion_along(x: Floats, n: Floats, centre: Floats, size: float) -> Floats:
    """Normal velocity of contact points in the six rigid-body modes: rows of the constraint matrix."""
    arm = (x - centre) / size
    return np.concatenate([n, np.cross(arm, n)], axis=1)


def _describe_motion(mode: Floats) -> str:
    names = (
        "translation x",
        "translation y",
        "translation z",
        "rotation about x",
        "rotation about y",
        "rotation about z",
    )
    strong = np.abs(mode) > 0.3 * np.abs(mode).max()
    return " with ".join(name for name, hit in zip(names, strong, strict=True) if hit)
