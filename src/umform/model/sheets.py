"""Contacts of the sheets of a model with each other and with themselves."""

from __future__ import annotations

from itertools import count
from typing import Any

from umform.errors import InvalidValue
from umform.mesh import Ids, Selector
from umform.model.contact.layers import layers_behind
from umform.model.contact.sheets import SheetContact, SheetContactOptions
from umform.model.contact.sheets.settings import sheet_contact_settings
from umform.model.contact.sheets.start import check_facing
from umform.model.equations.evaluated import Evaluated
from umform.spec import takes


class SheetContacts:
    """Contacts of the sheets of a model.

    Parameters
    ----------
    system : System
        The equations of the model, to which the contacts are added.
    """

    def __init__(self, system: Evaluated) -> None:
        self.system = system

    @takes(SheetContactOptions)
    def sheet_contact(self, /, faces: Selector, others: Selector, *, name: str = "", **options: Any) -> SheetContact:
        """Define contact between the faces of two sheets, or of two faces of one sheet.

        Parameters
        ----------
        faces, others : Selector
            Lower or upper faces; the order does not matter.
        name : str, optional
            For the history: the columns ``<name>_fx`` ... are the force of the second sheet on the first one.
        **options
            Penalty, points, cells, friction: the fields of
            :class:`umform.model.contact.sheets.SheetContactOptions`.

        Raises
        ------
        InvalidPenalty, InvalidFriction, InvalidValue
            If a number is out of range, the two share a face or look the same way, or the name is taken.
        """
        mesh = self.system.mesh
        one, other = mesh.face_set(faces), mesh.face_set(others)
        name = self._named(name)
        if set(map(tuple, one.tolist())) & set(map(tuple, other.tolist())):
            raise InvalidValue(
                "a face is on both sides of a contact",
                where=f"contact {name}",
                value=f"{faces!r} and {others!r}" if isinstance(faces, str) else "the same rows",
                cause="the same set, or sets that overlap",
                remedy="self_contact(faces) for a sheet that touches itself",
            )
        check_facing(mesh, mesh.displaced(self.system.u), (one, other), f"contact {name}")
        return self._made([one, other], name, options)

    @takes(SheetContactOptions)
    def self_contact(self, /, faces: Selector, *, name: str = "", **options: Any) -> SheetContact:
        """Define contact of the faces of a sheet with themselves, as in a hem.

        Parameters
        ----------
        faces : Selector
            Lower or upper faces.
        name : str, optional
            For the history.
        **options
            As for :meth:`sheet_contact`.

        Raises
        ------
        InvalidPenalty, InvalidFriction, InvalidValue
            If a number is out of range, or the name is taken.
        """
        return self._made([self.system.mesh.face_set(faces)], self._named(name), options)

    def _made(self, sides: list[Ids], name: str, options: dict[str, Any]) -> SheetContact:
        try:
            wanted = SheetContactOptions(**options)
        except InvalidValue as error:
            error.where = f"contact {name}, {error.where}"
            raise
        mesh = self.system.mesh
        layers = [layers_behind(self.system.bodies, side[:, 0])[0] for side in sides]
        settings = sheet_contact_settings(mesh, sides, layers, wanted, f"contact {name}")
        contact = SheetContact(mesh, sides, settings, name)
        self.system.add(contact)
        return contact

    def _named(self, name: str) -> str:
        taken = {term.name for term in self.system.terms}
        return name or next(free for k in count(1) if (free := f"sheets{k}") not in taken)
