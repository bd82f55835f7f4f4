"""Equivalent draw beads on the tools of a model."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, count
from typing import Any

from numpy.typing import ArrayLike

from umform.errors import InvalidBead
from umform.mesh import Selector
from umform.model.contact.bead import Bead, BeadOptions, bead_line
from umform.model.contact.pair import Contact
from umform.model.equations.evaluated import Evaluated
from umform.model.tools.tool import Tool
from umform.spec import takes


class Beads:
    """Equivalent draw beads on the tools of a model.

    Parameters
    ----------
    system : System
        The equations of the model, to which beads are added.
    """

    def __init__(self, system: Evaluated) -> None:
        self.system = system

    @takes(BeadOptions, "curve")
    def bead(
        self,
        /,
        faces: Selector,
        tool: Contact | Tool,
        curve: ArrayLike | Sequence[ArrayLike],
        *,
        name: str = "",
        **options: Any,
    ) -> Bead:
        """Add an equivalent draw bead: a line on a tool that restrains the sheet, in place of a modelled bead.

        The tool must touch the sheet by a :meth:`contact` as well: a bead acts in full up to a gap of a quarter of
        the thickness, and not at all from half of it on.

        Parameters
        ----------
        faces : Selector
            Faces that touch the tool; at least those that are drawn through the bead.
        tool : Tool or Contact
            The tool that the line lies on, or a pair that touches it.
        curve : array_like, shape (k, 3)
            Corners of the line on the tool, in its initial position.
        name : str, optional
            For the history: the columns ``<name>_restraint`` and ``_lift`` are the sums of these forces, ``_work`` is
            the work of the restraint; ``_active`` and ``_slipping`` count points in the band.
        **options
            Restraint, width, uplift ...: the fields of :class:`umform.model.contact.bead.BeadOptions`.

        Returns
        -------
        Bead
            The bead; its forces are part of those of the tool.

        Raises
        ------
        InvalidBead
            If a number is out of range, or the line is invalid or not on its tool.
        InvalidValue
            If the name is taken.
        """
        name = name or self._free_bead_name()
        where = f"bead {name}"
        tool = tool.tool if isinstance(tool, Contact) else tool
        if not isinstance(tool, Tool) or tool not in self.system.tools:
            raise InvalidBead(
                "a bead lies on a tool of the model",
                where=where,
                value=type(tool).__name__,
                cause="a surface, or a tool of another model",
                remedy="what contact() or tool() of this model returned",
            )
        try:
            wanted = BeadOptions(curve, **options)  # type: ignore[arg-type]
        except InvalidBead as error:
            error.where = f"{where}, {error.where}"
            raise
        bead = Bead(
            self.system.mesh, faces, tool, bead_line(self.system.mesh, tool, wanted, where), wanted.points, name
        )
        self.system.add(bead)
        tool.pairs.append(bead)
        return bead

    def _free_bead_name(self) -> str:
        taken = {term.name for term in self.system.others} | {pair.name for pair in self.system.contacts}
        return next(name for name in chain(["bead"], (f"bead{k}" for k in count(2))) if name not in taken)
