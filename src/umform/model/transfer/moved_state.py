"""The state of the elements of a part that were moved or added, and its energy. docs/theory, section 1.7"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import MeshError
from umform.mesh.fitted.layer import Layer
from umform.mesh.fitted.sheet import Sheet
from umform.model.bodies.body import Body
from umform.model.model import Model
from umform.model.terms.term import Energies, Found
from umform.model.transfer.fitted_part import FittedMesh
from umform.model.transfer.transfer import Transfer, Weights, can_transfer, energies_at_points, flowed

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Largest number of corrections of enhanced parameters; the change that ends them, relative to them.
_CORRECTIONS, _SETTLED = 12, 1e-9
#: Largest change of the energy of the part, relative to that of its metal; strain that counts as zero. eq. (1.34)
_ALLOWED, _NO_STRAIN = 0.02, 1e-6


def refuse_unknown(whole: Model) -> None:
    """Reject laws whose history cannot be interpreted.

    Raises
    ------
    MeshError
        If there are any.
    """
    for body in whole.bodies:
        if not can_transfer(body):
            raise MeshError(
                "the meaning of the history of a law is unknown, so it cannot be moved to other points",
                where=body.name,
                value=type(body.material).__name__,
            )


@dataclass(frozen=True)
class _Layer:
    """Cells of one layer and one body that change: their rows in the body, and of the old one where they lie."""

    old: Body
    of: Numbers
    new: Body
    rows: Numbers
    stacks: Numbers
    weights: Weights


def move_state(whole: Model, sheet: Sheet, x: Floats, layer: Layer, made: FittedMesh, model: Model) -> None:
    """Give the changed cells of a model, which have the state of their parents, that of their places. eq. (1.32)

    Raises
    ------
    MeshError
        If the energy of the part changes.
    """
    layers = sheet.cells.shape[1]
    stacks = np.flatnonzero(~made.same.reshape(-1, layers)[:, 0])
    there = np.concatenate([x, np.zeros((layer.new, 2))])
    there[layer.moved] = np.einsum("na,nai->ni", layer.places.weights, x[sheet.quads[layer.places.quad]])
    corners = there[layer.quads[stacks]]
    moves = []
    for body in model.bodies:
        old = next(other for other in whole.bodies if other.name == body.name)
        for k in range(layers):
            cells = stacks * layers + k
            own = np.flatnonzero(np.isin(cells, body.cells))
            if len(own) == 0:
                continue
            sources = np.flatnonzero(np.isin(sheet.cells[:, k], old.cells))
            weights = Weights.between(sheet, x, sources, corners[own], body.element.surface_rule, body.through[0])
            of = np.searchsorted(old.cells, sheet.cells[weights.stacks, k])
            moves.append(_Layer(old, of, body, np.searchsorted(body.cells, cells[own]), own, weights))
    state, plastic = model.system.snapshot(), _plastic(moves, len(stacks))
    for with_history in (plastic, np.ones_like(plastic)):
        model.system.restore(state)
        _transfer(whole, model, moves, with_history)
        _settle(model, made)
        problem = _changed_energy(whole, model, moves)
        if not problem:
            return
    raise MeshError("elements that end on the line would change the metal", value=problem)


def _plastic(moves: list[_Layer], stacks: int) -> NDArray[np.bool_]:
    """Stacks that change beside metal that has flowed."""
    plastic = np.zeros(stacks, dtype=bool)
    for move in moves:
        plastic[move.stacks] |= flowed(move.old, move.of, move.weights)
    return plastic


def _transfer(whole: Model, model: Model, moves: list[_Layer], plastic: NDArray[np.bool_]) -> None:
    """Give the changed cells their history and enhanced parameters; stacks that are not plastic the initial history."""
    for move in moves:
        history, alpha = move.new.block.state, move.new.block.alpha
        of = Transfer(move.old, move.of, whole.u, move.weights)
        history[move.rows], alpha[move.rows] = of.to(move.new, move.rows, model.mesh, model.u, plastic[move.stacks])
        move.new.restore({"history": history, "alpha": alpha})


def _settle(model: Model, made: FittedMesh) -> None:
    """Bring the enhanced parameters of the changed cells to equilibrium at fixed nodes. eq. (2.19)"""
    history = [body.block.state for body in model.bodies]
    alpha = [body.block.alpha for body in model.bodies]
    zero = np.zeros_like(model.u)
    for _ in range(_CORRECTIONS):
        if model.system.evaluate(model.u).failed >= 0:
            raise MeshError("the state of the sheet cannot be carried by elements that end on the line")
        change = 0.0
        for k, body in enumerate(model.bodies):
            body.recover(zero, False)
            body.block.commit()
            after = body.block.alpha
            after[made.same[body.cells]] = alpha[k][made.same[body.cells]]
            change = max(change, float(np.abs(after - alpha[k]).max(initial=0.0)))
            alpha[k] = after
            body.restore({"history": history[k], "alpha": after})
        if change <= _SETTLED * max(float(np.abs(a).max(initial=0.0)) for a in alpha):
            break


def _changed_energy(whole: Model, model: Model, moves: list[_Layer]) -> str:
    """Which energy of the part is not that of its metal, or is more than that of the sheet; "" if none. eq. (1.34)"""
    change, zero = np.zeros(2), 0.0
    for move in moves:
        before = energies_at_points(move.old, whole.u)[0][move.of]
        after, volume = (values[move.rows] for values in energies_at_points(move.new, model.u))
        change += ((after - move.weights.mean(before)) * volume[..., None]).sum(axis=(0, 1))
        zero += _energy_of_no_strain(move.new) * float(volume.sum())
    all_of_it, part = _energies(whole), _energies(model)
    for k, kind in enumerate(("elastic energy", "plastic work")):
        had = part[k] - change[k]
        if abs(change[k]) > _ALLOWED * had + zero:
            return f"{kind} {part[k]:.4g} instead of {had:.4g}: the elements are coarse for the bend at the line"
        if part[k] > all_of_it[k] + zero:
            return f"{kind} {part[k]:.4g}, {all_of_it[k]:.4g} in the whole sheet: coarse elements at the line"
    return ""


def _energies(model: Model) -> Floats:
    """Elastic energy and plastic work of all bodies."""
    found: list[Energies] = [body.energies(Found(), model.u) for body in model.bodies]
    return np.array([sum(e.elastic for e in found), sum(e.plastic for e in found)])


def _energy_of_no_strain(body: Body) -> float:
    """Elastic energy per volume of a strain that counts as zero; 0 if the law does not know it."""
    law = body.material.law()
    strain = _NO_STRAIN * np.eye(6)[:1]
    energy = law.energy(strain, np.array(law.initial(), dtype=float)[None, :])[0]
    return float(np.nan_to_num(energy[0]))
