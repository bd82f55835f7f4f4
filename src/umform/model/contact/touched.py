"""The contacts of a model: pairs of faces and tools, and what moves the tools."""

from __future__ import annotations

from numpy.typing import ArrayLike

from umform.errors import InvalidValue
from umform.materials import Material
from umform.mesh import Mesh, Selector
from umform.model import boundary
from umform.model.contact.pair import Contact, Motion, ToolMotion
from umform.model.contact.settings import contact_settings
from umform.model.controls import Controlled
from umform.ranks import Ranks
from umform.surfaces import Direction, Surface, unit_vector


class Touched(Controlled):
    """Faces of a mesh that touch rigid tools."""

    mesh: Mesh
    material: Material
    ranks: Ranks

    def __init__(self) -> None:
        super().__init__()
        self.contacts: list[Contact] = []

    def touching(self) -> bool:
        """Whether a tool holds the sheet anywhere, by the last evaluation."""
        return self.ranks.any(any(bool(contact.active().any()) for contact in self.contacts))

    def contact(
        self,
        faces: Selector,
        tool: Surface,
        *,
        penalty: float | None = None,
        penetration: float | None = None,
        points: int | str = 2,
        augmented: bool = False,
        name: str = "",
    ) -> Contact:
        """Let faces touch a rigid tool.

        Parameters
        ----------
        faces : Selector
            Lower or upper faces.
        tool : Surface
            A tool of :mod:`umform.surfaces`, or UserSurface.
        penalty : float, optional
            Pressure per penetration. Without it, it follows from the penetration that is allowed, the strength of the
            sheet and the radius of the tool. eq. (4.29)
        penetration : float, optional
            Penetration that is allowed, instead of the penalty; default 1/200 of the thickness of the sheet. A run that
            exceeds it is warned.
        points : int, "auto" or "nodes"
            Gauss points per direction and facet, 1 to 10, or as many as the length that touches asks for by eq. (4.31),
            or the nodes with their tributary areas. Take at least 2 on 4-node and 3 on 9-node facets.
        augmented : bool
            Take what penetrates further than allowed back, by multipliers; penalty and penetration may then both be
            given. It costs a few iterations more in each increment.
        name : str, optional
            For the history: the columns ``<name>_fx`` ... are the force on the tool.

        Raises
        ------
        InvalidPenalty, InvalidValue
            If a number is out of range, penalty and penetration say the same thing, or the name is taken.
        """
        name = name or f"tool{len(self.contacts) + 1}"
        if any(other.name == name for other in self.contacts):
            raise InvalidValue("two contacts have the same name", value=name)
        settings = contact_settings(
            self.mesh,
            faces,
            tool,
            self.material,
            penalty=penalty,
            penetration=penetration,
            points=points,
            augmented=augmented,
            where=f"contact {name}",
        )
        contact = Contact(self.mesh, faces, tool, settings, name)
        self.contacts.append(contact)
        self._assembled = None
        return contact

    def drive(self, contact: Contact, direction: Direction, name: str = "") -> ToolMotion:
        """Let steps move a tool along a direction.

        Parameters
        ----------
        contact : Contact
            The pair whose tool moves.
        direction : str or array_like, shape (3,)
            "z", "-x", ... or a vector.
        name : str, optional
            Column of the history.

        Returns
        -------
        ToolMotion
            The control whose value (a length) steps move; its force is that of the sheet on the tool along it.
        """
        control = ToolMotion(name or self._name(contact.name), direction=unit_vector(direction, "drive"))
        contact.translations.append(control)
        return self._add(control)

    def set_motion(self, contact: Contact, motion: Motion, about: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """Give a tool a motion in time, in addition to what steps do to it.

        Parameters
        ----------
        contact : Contact
            The pair whose tool moves.
        motion : callable
            time -> translation (3,), or (translation (3,), rotation vector (3,)).
        about : array_like, shape (3,)
            Point of the tool that the rotation is about.
        """
        contact.motion = motion
        contact.reference_point = boundary.vector3(about, "about")
