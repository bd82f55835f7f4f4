"""The tools of a model and the faces in contact with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import count

import numpy as np

from umform.errors import InvalidValue
from umform.mesh import Mesh, Selector
from umform.model.body import Body
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.friction import AnyFriction
from umform.model.contact.pair import Contact
from umform.model.contact.settings import contact_settings
from umform.model.tool import Tool
from umform.model.tools import Tools
from umform.surfaces import Surface, UserSurface
from umform.surfaces.user_check import check_beside


class Contacts(list[Contact]):
    """The pairs of faces and tools of a model.

    Parameters
    ----------
    mesh : Mesh
        Points and cells.
    bodies : sequence of Body
        Bodies of the model: their strength sets a penalty.
    tools : Tools
        Tools of the model, to which those of single pairs are added.
    """

    def __init__(self, mesh: Mesh, bodies: Sequence[Body], tools: Tools) -> None:
        super().__init__()
        self.mesh, self.bodies, self.tools = mesh, bodies, tools

    def contact(
        self,
        faces: Selector,
        tool: Surface | Tool,
        *,
        penalty: float | None = None,
        penetration: float | None = None,
        points: int | str | None = None,
        cells: int | str | None = None,
        ripple: float | None = None,
        augmented: bool = False,
        friction: AnyFriction | None = None,
        slip: float | None = None,
        name: str = "",
    ) -> Contact:
        """Define contact of faces with a rigid tool.

        Parameters
        ----------
        faces : Selector
            Lower or upper faces.
        tool : Surface or Tool
            A tool of :mod:`umform.surfaces`, or UserSurface; or the return value of :meth:`tool`, which several pairs
            share.
        penalty : float, optional
            Pressure per penetration. Default: from the allowed penetration, the strength of the sheet and the
            radius of the tool. eq. (4.29)
        penetration : float, optional
            Allowed penetration, instead of the penalty; default 1/200 of the sheet thickness. A run that exceeds it
            warns.
        points : int, "auto" or "nodes"
            Gauss points per direction and facet, 1 to 10, or as many as the contact length requires by eq. (4.31),
            or the nodes with their tributary areas; default 2. Use at least 2 on 4-node and 3 on 9-node facets.
        cells : int or "auto", optional
            Instead of points: cells per direction and facet, 1 to 20, over which a linear gap is integrated up to the
            moving edge of contact, so that the force is smooth; "auto": as many as the allowed ripple requires, eq.
            (4.122). Use at least 3 on 4-node and 5 on 9-node facets. The tangent is unsymmetric. docs/cells.md
        ripple : float, optional
            Allowed relative ripple of the force with cells="auto"; default 0.001.
        augmented : bool
            Remove excess penetration by multipliers; penalty and penetration may then both be given. Costs a few
            iterations per increment.
        friction : float, Friction, FrictionByRegion or callable, optional
            Coefficient of friction or a law, see :class:`umform.Friction`, or a function (pressure, accumulated slip,
            position in the tool frame) -> largest tangential traction. Default: none.
        slip : float, optional
            Allowed elastic slip: displacement of a sticking point before it slips, at any pressure; default 1/200 of
            the sheet thickness. Multipliers remove it.
        name : str, optional
            For the history: the columns ``<name>_fx`` ... are the force on the tool.

        Raises
        ------
        InvalidPenalty, InvalidFriction, InvalidValue
            If a number is out of range, both penalty and penetration are given, or the name is taken.
        """
        name = name or self._free_pair_name()
        if any(other.name == name for other in self):
            raise InvalidValue(
                "two contacts have the same name",
                where=f"contact {name}",
                value=name,
                cause="the columns of the history and the fields go by it",
                remedy="contact(..., name=...) with another one",
            )
        surface = tool.surface if isinstance(tool, Tool) else tool
        if isinstance(surface, UserSurface):
            facets = self.mesh.facets(faces)[:, :4]
            check_beside(surface, self.mesh.points[facets], sheet_thickness(self.mesh), f"contact {name}")
        body = self._body_of(faces)
        settings = contact_settings(
            self.mesh,
            faces,
            surface,
            body.material,
            penalty=penalty,
            penetration=penetration,
            points=points,
            cells=cells,
            ripple=ripple,
            augmented=augmented,
            friction=friction,
            slip=slip,
            where=f"contact {name}",
        )
        if body.element.plane_strain and not augmented and settings.cells is None and self._one_side(faces):
            settings = replace(settings, width_points=body.element.width_points)
        touched = tool if isinstance(tool, Tool) else Tool(name, tool, self.tools.now)
        contact = Contact(self.mesh, faces, touched, settings, name)
        new = contact if isinstance(tool, Tool) else touched
        self.tools.controls.refuse_taken(
            [*contact.column_names(), *(new.column_names() if new is touched else ())], name
        )
        if touched not in self.tools:
            self.tools.append(touched)
        touched.pairs.append(contact)
        self.append(contact)
        self.tools.now.restructured()
        return contact

    def _free_pair_name(self) -> str:
        taken = {pair.name for pair in self} | {tool.name for tool in self.tools}
        return next(name for k in count(len(taken) + 1) if (name := f"tool{k}") not in taken)

    def _one_side(self, faces: Selector) -> bool:
        """Whether faces are all lower ones, or all upper ones."""
        return len(set(self.mesh.face_set(faces)[:, 1].tolist())) == 1

    def _body_of(self, faces: Selector) -> Body:
        """Body that most of the faces belong to."""
        cells = self.mesh.face_set(faces)[:, 0]
        return max(self.bodies, key=lambda body: int(np.isin(cells, body.cells).sum()))
