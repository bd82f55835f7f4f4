"""Motion of the tools of a model: translations, rotations, forces, springs, stops, followers, motions in time."""

from __future__ import annotations

import math

from umform.errors import InvalidValue
from umform.model.contact.pair import Contact
from umform.model.terms import forces
from umform.model.terms.controls import Controls
from umform.model.terms.forces import Vector
from umform.model.terms.present_state import Now
from umform.model.terms.term import Global
from umform.model.tools.press import Press, Stiffness, Stop
from umform.model.tools.tool import Motion, Tool
from umform.model.tools.tool_controls import ToolForce, ToolMotion, ToolTurn, ToolWay, refuse_given_and_found, turn_of
from umform.spec import check_arguments
from umform.surfaces import Direction, Surface, unit_vector


class Tools(list[Tool]):
    """The tools of a model, and the controls that move them.

    Parameters
    ----------
    controls : Controls
        Controls of the model, to which motions and forces are added.
    now : Now
        The present state of the model.
    """

    def __init__(self, controls: Controls, now: Now) -> None:
        super().__init__()
        self.controls, self.now = controls, now

    def tool(self, name: str, surface: Surface) -> Tool:
        """Define a rigid tool that several contact pairs may share.

        Parameters
        ----------
        name : str
            For the history: the columns ``<name>_fx`` ... are force and moment of the sheet on it, over all its pairs.
        surface : Surface
            A tool of :mod:`umform.surfaces`, or UserSurface.

        Raises
        ------
        InvalidValue
            If the name is taken, or the surface is invalid.
        """
        tool = Tool(name, surface, self.now)
        self.controls.refuse_taken(tool.column_names(), name)
        self.append(tool)
        return tool

    def drive(self, tool: Contact | Tool, direction: Direction, name: str = "") -> ToolMotion:
        """Let steps move a tool along a direction.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        direction : str or array_like, shape (3,)
            Direction: "z", "-x", ... or a vector.
        name : str, optional
            Column of the history.

        Returns
        -------
        ToolMotion
            The control whose value (a length) steps move; its force is that of the tool on the sheet along it.
        """
        tool = self.own(tool)
        way = ToolMotion(
            name or self.controls.free_name(tool.name), direction=unit_vector(direction, "drive"), tool=tool
        )
        refuse_given_and_found([press.way for press in tool.presses], way, way.name)
        self.controls.add(way)
        tool.add_way(way)
        return way

    def turn(self, tool: Contact | Tool, axis: Direction, about: Vector = (0.0, 0.0, 0.0), name: str = "") -> ToolTurn:
        """Let steps turn a tool about an axis.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        axis : str or array_like, shape (3,)
            Axis of rotation at the present position of the tool.
        about : array_like, shape (3,)
            Point of the axis.
        name : str, optional
            Column of the history.

        Returns
        -------
        ToolTurn
            The control whose value (an angle in radians) steps move; its force is the moment of the tool on the sheet.
        """
        tool = self.own(tool)
        way = turn_of(name or self.controls.free_name(f"{tool.name}_turn"), tool, axis, about)
        refuse_given_and_found([press.way for press in tool.presses], way, way.name)
        self.controls.add(way)
        tool.add_way(way)
        return way

    def press(self, tool: Contact | Tool, direction: Direction, name: str = "") -> ToolForce:
        """Let steps press a tool with a force along a direction; its displacement is an unknown.

        The sheet must support the tool: without contact there is no equilibrium.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        direction : str or array_like, shape (3,)
            Direction of the force and of the displacement.
        name : str, optional
            Column of the history; the displacement is the column ``<name>_way``.

        Returns
        -------
        ToolForce
            The control whose value (a force on the tool) steps move.

        Raises
        ------
        InvalidValue
            If the tool is driven, pressed or sprung along this direction already.
        """
        tool = self.own(tool)
        name = name or self.controls.free_name(f"{tool.name}_press")
        return self._pressed(ToolMotion(f"{name}_way", direction=unit_vector(direction, "press"), tool=tool), name)

    def press_turn(
        self, tool: Contact | Tool, axis: Direction, about: Vector = (0.0, 0.0, 0.0), name: str = ""
    ) -> ToolForce:
        """Let steps turn a tool with a moment about an axis; its angle is an unknown.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        axis : str or array_like, shape (3,)
            Axis of rotation at the present position of the tool.
        about : array_like, shape (3,)
            Point of the axis.
        name : str, optional
            Column of the history; the angle in radians is the column ``<name>_way``.

        Returns
        -------
        ToolForce
            The control whose value (a moment on the tool) steps move.
        """
        tool = self.own(tool)
        name = name or self.controls.free_name(f"{tool.name}_moment")
        return self._pressed(turn_of(f"{name}_way", tool, axis, about), name)

    def spring(
        self, tool: Contact | Tool, direction: Direction, stiffness: Stiffness, preload: float = 0.0, name: str = ""
    ) -> ToolForce:
        """Support a tool by a spring, such as a pad on gas springs; its displacement is an unknown.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        direction : str or array_like, shape (3,)
            Direction in which the spring pushes the tool.
        stiffness : float
            Force per length.
        preload : float
            Force of the spring at the present position of the tool.
        name : str, optional
            Column of the history; the displacement is the column ``<name>_way``.

        Returns
        -------
        ToolForce
            A control of a further force on the tool along the same direction.
        """
        tool = self.own(tool)
        name = name or self.controls.free_name(f"{tool.name}_spring")
        check_arguments(Tools.spring, f"spring {name}", stiffness=stiffness, preload=preload)
        way = ToolMotion(f"{name}_way", direction=unit_vector(direction, "spring"), tool=tool)
        force = self._pressed(way, name)
        tool.presses[-1].stiffness, tool.presses[-1].free = stiffness, preload / stiffness
        return force

    def stop(self, force: ToolForce, at: float, stiffness: Stiffness | None = None, *, below: bool = False) -> None:
        """Limit the displacement of a pressed or sprung tool by a stop: distance blocks, the end of a gas spring.

        Parameters
        ----------
        force : ToolForce
            Return value of :meth:`press`, :meth:`press_turn` or :meth:`spring`.
        at : float
            Displacement at which the tool meets it.
        stiffness : float, optional
            Force per length beyond; by default it is rigid, and the column ``<name>_stop`` its force on the tool.
        below : bool
            Whether it is a lower bound of the displacement; by default an upper bound.

        Raises
        ------
        InvalidValue
            If a number is invalid, or the range between rigid stops is empty.
        """
        press = self.press_of(force)
        check_arguments(Tools.stop, f"stop of {force.name}", at=at, stiffness=stiffness)
        if stiffness is None and not any(stop.rigid for stop in press.stops):
            self.controls.refuse_taken([f"{force.name}_stop"], f"{force.name}_stop")
        press.stops.append(Stop(float(at), math.inf if stiffness is None else float(stiffness), -1.0 if below else 1.0))
        least, largest = press.bounds
        if least > largest:
            press.stops.pop()
            raise InvalidValue(
                "two rigid stops leave a tool no way between them",
                where=f"stop of {force.name}",
                value=f"not below {least:.6g}, not beyond {largest:.6g}",
                cause="the sign of a way, or below= at the wrong one",
                remedy="the lower one with below=True, at a smaller way than the upper one",
            )

    def attach(self, tool: Contact | Tool, way: ToolWay) -> None:
        """Let a tool follow the displacement or rotation of another one, at its present distance.

        A pad on springs in a punch follows the punch and moves relative to it by :meth:`spring`; a holder that keeps a
        gap follows the die. The force of the control is then that on both tools.

        Parameters
        ----------
        tool : Tool or Contact
            The tool that follows, or a pair that touches it.
        way : ToolMotion or ToolTurn
            Return value of :meth:`drive` or :meth:`turn` for the other tool.

        Raises
        ------
        InvalidValue
            If the tool already follows it, or the control belongs to another model.
        """
        tool = self.own(tool)
        if way not in self.controls or not isinstance(way, ToolWay) or tool in way.tools:
            raise InvalidValue(
                "a tool follows the way of another tool of the model, once",
                where=f"tool {tool.name}",
                value=getattr(way, "name", way),
                cause="its own way, one that it follows already, a force, or one of another model",
                remedy="what drive() or turn() returned for the other tool",
            )
        way.followers.append(tool)
        tool.add_way(way)

    def press_of(self, force: ToolForce) -> Press:
        """The press that a force control acts on.

        Raises
        ------
        InvalidValue
            If it acts on no tool of the model.
        """
        for press in (press for tool in self for press in tool.presses):
            if press.force is force:
                return press
        raise InvalidValue(
            "the control presses no tool of the model",
            where="press_of()",
            value=force,
            cause="a way, a load, or a control of another model",
            remedy="what press(), press_turn() or spring() returned",
        )

    def _pressed(self, way: ToolWay, name: str) -> ToolForce:
        """A force control with its unknown travel; both or none."""
        tool = way.tool
        refuse_given_and_found(tool.ways, way, name)
        force = ToolForce(name, way=way)
        self.controls.refuse_taken([way.name, f"{way.name}_force", name, f"{name}_force"], name)
        self.controls.add(force)
        self.controls.add(way)
        tool.add_way(way)
        what = f"the way of tool {tool.name}, which {name} presses,"
        tool.add_press(Press(Global(f"{name}_found", {way: 1.0}, what=what), way, force))
        return force

    def set_motion(self, tool: Contact | Tool, motion: Motion, about: Vector = (0.0, 0.0, 0.0)) -> None:
        """Prescribe a motion of a tool in time, in addition to that of the steps.

        Parameters
        ----------
        tool : Tool or Contact
            The tool, or a pair that touches it.
        motion : callable
            time -> translation (3,), or (translation (3,), rotation vector (3,)).
        about : array_like, shape (3,)
            Point of the tool about which it rotates.
        """
        tool = self.own(tool)
        if not callable(motion):
            raise InvalidValue(
                "a motion in time is a function",
                where=f"motion of tool {tool.name}",
                value=motion,
                cause="a translation, or the values of the function",
                remedy="lambda time: (0.0, 0.0, -5.0 * time)",
            )
        point = forces.vector3(about, "about")
        tool.motion, tool.reference_point = motion, point

    def own(self, tool: Contact | Tool) -> Tool:
        """The tool of a pair, or a tool; one of another model is refused."""
        own = tool.tool if isinstance(tool, Contact) else tool
        if own not in self:
            raise InvalidValue(
                "the model has no such tool",
                where="tools",
                value=getattr(own, "name", own),
                cause="it belongs to another model, or is a surface",
                remedy="what tool() or contact() of this model returned",
            )
        return own
