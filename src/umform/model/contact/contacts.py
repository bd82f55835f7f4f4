"""The tools of a model and the faces in contact with them."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import Any

from umform.errors import InvalidValue
from umform.mesh import Mesh, Selector
from umform.model.bodies.bodies import Bodies
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.layers import layers_behind
from umform.model.contact.pair import Contact
from umform.model.contact.settings import ContactOptions, contact_settings
from umform.model.contact.tools import Tools
from umform.model.tools.tool import Tool
from umform.spec import takes
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

    def __init__(self, mesh: Mesh, bodies: Bodies, tools: Tools) -> None:
        super().__init__()
        self.mesh, self.bodies, self.tools = mesh, bodies, tools

    @takes(ContactOptions)
    def contact(
        self,
        /,
        faces: Selector,
        tool: Surface | Tool,
        *,
        name: str = "",
        **options: Any,
    ) -> Contact:
        """Define contact of faces with a rigid tool.

        Parameters
        ----------
        faces : Selector
            Lower or upper faces.
        tool : Surface or Tool
            A tool of :mod:`umform.surfaces`, or UserSurface; or the return value of :meth:`tool`, which several pairs
            share.
        name : str, optional
            For the history: the columns ``<name>_fx`` ... are the force on the tool.
        **options
            Penalty, penetration, points, friction ...: the fields of :class:`umform.model.contact.ContactOptions`.

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
                cause="columns of the history and fields have its name",
                remedy="contact(..., name=...) with another one",
            )
        if isinstance(tool, Tool) and tool not in self.tools:
            raise InvalidValue(
                "the model has no such tool",
                where=f"contact {name}",
                value=tool.name,
                cause="it belongs to another model",
                remedy="what tool() of this model returned, or a surface",
            )
        surface = tool.surface if isinstance(tool, Tool) else tool
        rows = self.mesh.face_set(faces)
        if isinstance(surface, UserSurface):
            facets = self.mesh.facets_of(rows)[:, :4]
            check_beside(surface, self.mesh.points[facets], sheet_thickness(self.mesh, rows), f"contact {name}")
        body, layers = self.bodies.of(rows[:, 0]), layers_behind(self.bodies, rows[:, 0])
        try:
            wanted = ContactOptions(**options)
        except InvalidValue as error:
            error.where = f"contact {name}, {error.where}"
            raise
        settings = contact_settings(self.mesh, faces, surface, layers, wanted, f"contact {name}")
        if body.element.plane_strain and not wanted.augmented and settings.cells is None and self._one_side(faces):
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
