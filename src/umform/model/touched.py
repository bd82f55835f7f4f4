"""The tools of a model, the faces that touch them, and what moves them."""

from __future__ import annotations

import math
from itertools import count

import numpy as np
from numpy.typing import ArrayLike

from umform.errors import InvalidValue
from umform.materials import Material
from umform.mesh import Mesh, Selector
from umform.model import forces
from umform.model.body import Body
from umform.model.contact.friction import AnyFriction
from umform.model.contact.pair import Contact
from umform.model.contact.settings import contact_settings
from umform.model.controls import Controlled
from umform.model.now import Now
from umform.model.term import Global
from umform.model.tool import Motion, Tool
from umform.model.tool_controls import Press, ToolForce, ToolMotion, ToolTurn, check_spring, turn_of
from umform.surfaces import Direction, Surface, unit_vector


class Touched(Controlled):
    """Faces of a mesh that touch rigid tools."""

    mesh: Mesh
    bodies: list[Body]

    def __init__(self) -> None:
        super().__init__()
        self.now = Now()
        self.tools: list[Tool] = []
        self.contacts: list[Contact] = []

    # Tools and pairs -----------------------------------------------------------------------------------------

    def tool(self, name: str, surface: Surface) -> Tool:
        """Make a rigid tool, which pairs of faces may touch.

        Parameters
        ----------
        name : str
            For the history: the columns ``<name>_fx`` ... are force and moment of the sheet on it, over all its pairs.
        surface : Surface
            A tool of :mod:`umform.surfaces`, or UserSurface.

        Raises
        ------
        InvalidValue
            If the name is taken, or the surface is none.
        """
        tool = Tool(name, surface, self.now)
        self._refuse_taken(tool.column_names(), name)
        self.tools.append(tool)
        return tool

    def contact(
        self,
        faces: Selector,
        tool: Surface | Tool,
        *,
        penalty: float | None = None,
        penetration: float | None = None,
        points: int | str | None = None,
        cells: int | None = None,
        augmented: bool = False,
        friction: AnyFriction | None = None,
        slip: float | None = None,
        name: str = "",
    ) -> Contact:
        """Let faces touch a rigid tool.

        Parameters
        ----------
        faces : Selector
            Lower or upper faces.
        tool : Surface or Tool
            A tool of :mod:`umform.surfaces`, or UserSurface; or what :meth:`tool` returned, which several pairs share.
        penalty : float, optional
            Pressure per penetration. Without it, it follows from the penetration that is allowed, the strength of the
            sheet and the radius of the tool. eq. (4.29)
        penetration : float, optional
            Penetration that is allowed, instead of the penalty; default 1/200 of the thickness of the sheet. A run that
            exceeds it is warned.
        points : int, "auto" or "nodes"
            Gauss points per direction and facet, 1 to 10, or as many as the length that touches asks for by eq. (4.31),
            or the nodes with their tributary areas; default 2. Take at least 2 on 4-node and 3 on 9-node facets.
        cells : int, optional
            Instead of points: cells per direction and facet, 1 to 20, over which a linear gap is integrated with the
            moving edge of contact, so that the force has no stairs. Take at least 3 on 4-node and 5 on 9-node facets.
            The tangent is unsymmetric. docs/cells.md
        augmented : bool
            Take what penetrates further than allowed back, by multipliers; penalty and penetration may then both be
            given. It costs a few iterations more in each increment.
        friction : float, Friction, FrictionByRegion or callable, optional
            Coefficient of friction or a law of it, see :class:`umform.Friction`; a function (pressure, distance slid,
            place in the frame of the tool) -> largest tangential traction. Default: none.
        slip : float, optional
            Elastic slip that is allowed: by so much a place that sticks may move before it slips where the pressure is
            the one that is expected; default 1/200 of the thickness of the sheet. Multipliers take it away.
        name : str, optional
            For the history: the columns ``<name>_fx`` ... are the force on the tool.

        Raises
        ------
        InvalidPenalty, InvalidFriction, InvalidValue
            If a number is out of range, penalty and penetration say the same thing, or the name is taken.
        """
        name = name or self._free_pair_name()
        if any(other.name == name for other in self.contacts):
            raise InvalidValue(
                "two contacts have the same name",
                where=f"contact {name}",
                value=name,
                cause="the columns of the history and the fields go by it",
                remedy="contact(..., name=...) with another one",
            )
        settings = contact_settings(
            self.mesh,
            faces,
            tool.surface if isinstance(tool, Tool) else tool,
            self._law_of(faces),
            penalty=penalty,
            penetration=penetration,
            points=points,
            cells=cells,
            augmented=augmented,
            friction=friction,
            slip=slip,
            where=f"contact {name}",
        )
        touched = tool if isinstance(tool, Tool) else Tool(name, tool, self.now)
        contact = Contact(self.mesh, faces, touched, settings, name)
        new = contact if isinstance(tool, Tool) else touched
        self._refuse_taken([*contact.column_names(), *(new.column_names() if new is touched else ())], name)
        if touched not in self.tools:
            self.tools.append(touched)
        touched.pairs.append(contact)
        self.contacts.append(contact)
        self._assembled = None
        return contact

    def _free_pair_name(self) -> str:
        taken = {pair.name for pair in self.contacts} | {tool.name for tool in self.tools}
        return next(name for k in count(len(taken) + 1) if (name := f"tool{k}") not in taken)

    def _law_of(self, faces: Selector) -> Material:
        """Law of the body that most of the faces belong to."""
        cells = self.mesh.face_set(faces)[:, 0]
        return max(self.bodies, key=lambda body: int(np.isin(cells, body.cells).sum())).material

    # What moves tools ----------------------------------------------------------------------------------------

    def drive(self, tool: Contact | Tool, direction: Direction, name: str = "") -> ToolMotion:
        """Let steps move a tool along a direction.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        direction : str or array_like, shape (3,)
            "z", "-x", ... or a vector.
        name : str, optional
            Column of the history.

        Returns
        -------
        ToolMotion
            The control whose value (a length) steps move; its force is that of the sheet on the tool along it.
        """
        tool = _tool_of(tool)
        way = ToolMotion(name or self._name(tool.name), direction=unit_vector(direction, "drive"), tool=tool)
        self._add(way)
        tool.add_way(way)
        return way

    def turn(
        self, tool: Contact | Tool, axis: Direction, about: ArrayLike = (0.0, 0.0, 0.0), name: str = ""
    ) -> ToolTurn:
        """Let steps turn a tool about an axis.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        axis : str or array_like, shape (3,)
            Axis of the turn where the tool stands now.
        about : array_like, shape (3,)
            Point of the axis.
        name : str, optional
            Column of the history.

        Returns
        -------
        ToolTurn
            The control whose value (an angle in radians) steps move; its force is the moment of the sheet on the tool.
        """
        tool = _tool_of(tool)
        way = turn_of(name or self._name(f"{tool.name}_turn"), tool, axis, about)
        self._add(way)
        tool.add_way(way)
        return way

    def press(self, tool: Contact | Tool, direction: Direction, name: str = "") -> ToolForce:
        """Let steps press a tool with a force along a direction; its way along it is found.

        The sheet must hold the tool: where nothing touches it, there is no equilibrium.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        direction : str or array_like, shape (3,)
            Direction of the force, and of the way.
        name : str, optional
            Column of the history; the way is the column ``<name>_way``.

        Returns
        -------
        ToolForce
            The control whose value (a force on the tool) steps move.

        Raises
        ------
        InvalidValue
            If the tool is driven, pressed or sprung along this direction already.
        """
        tool = _tool_of(tool)
        return self._pressed(tool, unit_vector(direction, "press"), name or self._name(f"{tool.name}_press"))

    def spring(
        self, tool: Contact | Tool, direction: Direction, stiffness: float, preload: float = 0.0, name: str = ""
    ) -> ToolForce:
        """Hold a tool by a spring along a direction, as a pad on gas springs; its way along it is found.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        direction : str or array_like, shape (3,)
            Direction in which the spring pushes the tool.
        stiffness : float
            Force per length.
        preload : float
            Force with which the spring pushes the tool where it stands now.
        name : str, optional
            Column of the history; the way is the column ``<name>_way``.

        Returns
        -------
        ToolForce
            A control of a further force on the tool along the same direction.
        """
        tool = _tool_of(tool)
        name = name or self._name(f"{tool.name}_spring")
        check_spring(stiffness, preload, f"spring {name}")
        force = self._pressed(tool, unit_vector(direction, "spring"), name)
        tool.presses[-1].stiffness, tool.presses[-1].free = stiffness, preload / stiffness
        return force

    def _pressed(self, tool: Tool, direction: tuple[float, float, float], name: str) -> ToolForce:
        """A force control with the way that it finds; all or nothing."""
        for way in tool.ways:
            if isinstance(way, ToolMotion) and abs(math.fsum(a * b for a, b in zip(way.direction, direction))) > 1e-9:
                raise InvalidValue(
                    "a tool cannot be driven and pressed along the same direction",
                    where=f"tool {tool.name}",
                    value=f"{way.name} along {way.direction}, {name} along {direction}",
                    cause="its way would be given and found at the same time",
                    remedy="press it along another direction, or drive it only",
                )
        way = ToolMotion(f"{name}_way", direction=direction, tool=tool)
        force = ToolForce(name, way=way)
        self._refuse_taken([way.name, f"{way.name}_force", name, f"{name}_force"], name)
        self._add(force)
        self._add(way)
        tool.add_way(way)
        tool.add_press(Press(Global(f"{name}_found", {way: 1.0}), way, [force]))
        return force

    def set_motion(self, tool: Contact | Tool, motion: Motion, about: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """Give a tool a motion in time, in addition to what steps do to it.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        motion : callable
            time -> translation (3,), or (translation (3,), rotation vector (3,)).
        about : array_like, shape (3,)
            Point of the tool that the rotation is about.
        """
        tool = _tool_of(tool)
        point = forces.vector3(about, "about")
        tool.motion, tool.reference_point = motion, point


def _tool_of(tool: Contact | Tool) -> Tool:
    return tool.tool if isinstance(tool, Contact) else tool
