"""Loads of a model: dead forces and follower pressure."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh, Selector
from umform.model.terms import forces
from umform.model.terms.controls import Controls
from umform.model.terms.dead_load import Load
from umform.model.terms.forces import Vector
from umform.model.terms.pressure import Pressure

Floats = NDArray[np.float64]


class Loads:
    """Loads on the nodes, faces and edges of a mesh: a sequence of the dead ones.

    Parameters
    ----------
    mesh : Mesh
        Points and cells.
    controls : Controls
        Controls of the model, to which loads are added.
    """

    def __init__(self, mesh: Mesh, controls: Controls) -> None:
        self.mesh, self.controls = mesh, controls

    def __iter__(self) -> Iterator[Load]:
        return iter(self.controls.of_kind(Load))

    def force(self, nodes: Selector, force: Vector, name: str = "") -> Load:
        """The same dead force on each node of a set.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        force : array_like, shape (3,)
            Force on each node for the value 1.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(forces.nodal_forces(self.mesh, nodes, force), name or self.controls.free_name("force"))

    def traction(self, faces: Selector, traction: Vector, name: str = "") -> Load:
        """Dead traction on faces of the cells, lateral ones too.

        Parameters
        ----------
        faces : str, callable or array_like
            Name of a set, predicate of x, y, z, or rows (cell, face), see :meth:`umform.Mesh.face_set`.
        traction : array_like, shape (3,)
            Force per reference area for the value 1.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(
            forces.traction_forces(self.mesh, faces, traction), name or self.controls.free_name("traction")
        )

    def line_load(self, faces: Selector, side: str, load: Vector, name: str = "") -> Load:
        """Dead load on the lower or upper edge of lateral faces; of a stack of them the lowest or the uppermost edge.

        Parameters
        ----------
        faces : str, callable or array_like
            Name of a set, predicate of x, y, z, or rows (cell, face), see :meth:`umform.Mesh.face_set`.
        side : {"lower", "upper"}
            Which of their edges.
        load : array_like, shape (3,)
            Force per reference length for the value 1.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(
            forces.edge_forces(self.mesh, faces, side, load), name or self.controls.free_name("line_load")
        )

    def body_force(self, force: Vector, name: str = "") -> Load:
        """Dead force in the volume.

        Parameters
        ----------
        force : array_like, shape (3,)
            Force per reference volume for the value 1.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(forces.body_forces(self.mesh, force), name or self.controls.free_name("body_force"))

    def pressure(self, faces: Selector, name: str = "") -> Pressure:
        """Follower pressure on lower or upper faces, against their outward normal; it makes the tangent unsymmetric.

        Parameters
        ----------
        faces : str, callable or array_like
            Name of a set, predicate of x, y, z, or rows (cell, face), see :meth:`umform.Mesh.face_set`.
        name : str, optional
            Column of the history.

        Returns
        -------
        Pressure
            The control whose value (force per current area) steps move.
        """
        return self.controls.add(
            Pressure.on(name or self.controls.free_name("pressure"), self.mesh, self.mesh.face_set(faces))
        )

    def add(self, load: Load) -> Load:
        """Add an existing load."""
        return self.controls.add(load)

    def _load(self, vector: Floats, name: str) -> Load:
        return self.controls.add(Load(name, vector=vector))
