"""The model: mesh, bodies, supports, loads and tools; residual and tangent at a state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.elements import BodyOptions, Element, Rolling
from umform.errors import InvalidValue, NotFinite
from umform.materials import Material
from umform.mesh import Mesh, Selector
from umform.mesh.numbers import unique
from umform.model.beads import Beads
from umform.model.bodies.bodies import Bodies
from umform.model.bodies.body import Body
from umform.model.changes import removal
from umform.model.changes.kept_gap import Gap, stop_at_gap
from umform.model.changes.opening import put_tool_back
from umform.model.contact import Contact
from umform.model.contact.contacts import Contacts
from umform.model.contact.tools import Tools
from umform.model.equations.assembled import Parts
from umform.model.equations.evaluation import Evaluation
from umform.model.equations.gauge import gauge_dofs
from umform.model.equations.rest_springs import Rest
from umform.model.equations.sparse_tangent import warn_of_pending
from umform.model.moved_names import MOVED, moved
from umform.model.sheets import SheetContacts
from umform.model.shown import ShownModel
from umform.model.supports.support import Support
from umform.model.supports.supports import Supports
from umform.model.system import System
from umform.model.terms.dead_load import Load
from umform.model.terms.loads import Loads
from umform.model.terms.state import Snapshot, State
from umform.model.tools.press import Stiffness
from umform.model.tools.tool import Tool
from umform.model.tools.tool_controls import ToolForce
from umform.ranks import ONE
from umform.spec import check_arguments, takes

Floats = NDArray[np.float64]
_P = ParamSpec("_P")
_R = TypeVar("_R")

#: Element of a model without bodies.
_USUAL = "ANS3DEAS"


def _of(part: str, method: Callable[Concatenate[Any, _P], _R]) -> Callable[Concatenate[Model, _P], _R]:
    """The method of a part as one of the model, with its text."""
    name = method.__name__

    @wraps(method)
    def thin(self: Model, /, *arguments: _P.args, **named: _P.kwargs) -> _R:
        found: _R = getattr(getattr(self, part), name)(*arguments, **named)
        return found

    thin.__qualname__ = f"Model.{name}"
    return thin


def _refuse_beside_bodies(**given: Any) -> None:
    """Refuse what bodies have themselves."""
    beside = {name: one for name, one in given.items() if one is not None and (name, one) != ("element", _USUAL)}
    if beside:
        raise InvalidValue(
            "give bodies, or element and material, with their options",
            where="Model",
            value=", ".join(beside),
            cause="bodies beside it: each has its own",
            remedy="give it to the bodies, or leave bodies out",
        )


def _told_of_pending(
    method: Callable[Concatenate[System, _P], Evaluation],
) -> Callable[Concatenate[Model, _P], Evaluation]:
    """An evaluation of the system as a method of the model; it warns once of enhanced parameters of another state.

    All of the residual is NaN if a cell cannot be evaluated.
    """

    @wraps(method)
    def evaluate(self: Model, /, *arguments: _P.args, **named: _P.kwargs) -> Evaluation:
        recovered = self.system.recovered
        # the system of a rank has a method of its own, which tells all ranks of a failure
        found: Evaluation = getattr(self.system, method.__name__)(*arguments, **named)
        if found.failed >= 0:
            found.residual.fill(np.nan)
        if self.system.ranks is ONE and not recovered and not self._told:
            self._told = warn_of_pending(self.system, found)
        return found

    evaluate.__qualname__ = "Model.evaluate"
    return evaluate


class Model(ShownModel):
    """Solid-shells with supports, loads and rigid tools.

    Parameters
    ----------
    mesh : Mesh
        Points and cells.
    element : str or Element
        Name in the catalogue (:data:`umform.elements.CATALOGUE`), or your own element.
    material : Material
        SVK, NeoHooke, NeoHookePower, J2, Metal, or your own law.
    bodies : sequence of Body, optional
        Several bodies instead of element and material; each cell belongs to one.
    rolling : array_like, shape (3,) or (cells, 3), or callable, optional
        Rolling direction of the sheet, or that of each cell in the order of their numbers, or a function of the
        coordinates x, y, z of the centres of the cells; :func:`umform.rolling_at` for an angle to a bend line. e_1 of
        the local axes is its projection onto the layer, eq. (1.26). By default e_1 lies along G_1 and follows the
        numbering of the mesh, which an isotropic law does not see.
    **options
        Options of the element, and its points through the thickness: thickness_points, thickness_rule,
        thickness_order, plane_strain ..., the fields of :class:`umform.elements.BodyOptions`.

    Raises
    ------
    WrongCellType
        If the element needs another cell type.
    InvalidValue
        If an option is invalid.

    Attributes
    ----------
    mesh : Mesh
        Points and cells.
    bodies : Bodies
        Its bodies, a list; ``bodies.only`` of a model with one.
    supports : Supports
        The active supports; held and prescribed degrees of freedom.
    controls : Controls
        Quantities that steps can move, a list.
    loads : Loads
        Dead loads.
    tools : Tools
        Rigid tools, a list.
    contacts : Contacts
        Pairs of faces and tools, a list.
    system : System
        Terms and unknowns, their evaluation, and the converged state: what Newton's method uses.
    carries_loose_sheet : bool
        Whether a run supports an initially loose sheet by weak springs until tools hold it, see :meth:`rest`.

    Examples
    --------
    >>> import umform as uf
    >>> strip = uf.mesh.strip(length=60.0, width=10.0, thickness=1.0, cells=(24, 1))
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
    >>> model = uf.Model(strip, element="ANS3DEAS", material=steel)
    >>> middle = model.symmetry("x0", normal="x")
    >>> punch = model.prescribe("x0_lower", "z", name="punch")
    >>> cylinder = model.contact("lower", uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20), name="cylinder")
    >>> steps = [uf.Move(punch, to=-15.0, steps=60), uf.Release(punch)]  # for uf.solve
    """

    carries_loose_sheet = True
    _origin: Any = None
    #: Whether a residual beside the equilibrium of enhanced parameters was reported.
    _told = False

    @takes(BodyOptions)
    def __init__(
        self,
        mesh: Mesh,
        element: str | Element = _USUAL,
        *,
        material: Material | None = None,
        bodies: Sequence[Body] | None = None,
        rolling: Rolling | None = None,
        **options: Any,
    ) -> None:
        if bodies is None:
            bodies = [Body(element, material=material, rolling=rolling, **options)]  # type: ignore[arg-type]
        else:
            _refuse_beside_bodies(element=element, material=material, rolling=rolling, **options)
        self._consist_of(System(Parts.on(mesh, Bodies.on(mesh, bodies))))
        self.system.whole.described = self

    def _consist_of(self, system: System) -> None:
        """Take the parts of a system."""
        self.system, self.mesh, self.bodies = system, system.mesh, system.bodies
        self.controls, self.supports, self.tools = system.controls, system.supports, system.tools
        self.contacts, self.loads, self._beads = system.contacts, Loads(system.mesh, system.controls), Beads(system)
        self._sheets = SheetContacts(system)

    fix, symmetry = _of("supports", Supports.fix), _of("supports", Supports.symmetry)
    hinge, hold_director = _of("supports", Supports.hinge), _of("supports", Supports.hold_director)
    prescribe = _of("supports", Supports.prescribe)
    prescribe_midline = _of("supports", Supports.prescribe_midline)

    force, traction = _of("loads", Loads.force), _of("loads", Loads.traction)
    line_load, pressure = _of("loads", Loads.line_load), _of("loads", Loads.pressure)

    contact, bead = _of("contacts", Contacts.contact), _of("_beads", Beads.bead)
    sheet_contact = _of("_sheets", SheetContacts.sheet_contact)
    self_contact = _of("_sheets", SheetContacts.self_contact)
    tool, drive, turn = _of("tools", Tools.tool), _of("tools", Tools.drive), _of("tools", Tools.turn)
    press, press_turn = _of("tools", Tools.press), _of("tools", Tools.press_turn)
    spring, stop = _of("tools", Tools.spring), _of("tools", Tools.stop)
    attach, set_motion = _of("tools", Tools.attach), _of("tools", Tools.set_motion)

    evaluate = _told_of_pending(System.evaluate)
    add, tangent = _of("system", System.add), _of("system", System.tangent)

    @property
    def u(self) -> Floats:
        """Displacement of the converged state, shape (3 n,)."""
        return self.system.u

    @u.setter
    def u(self, value: Floats) -> None:
        if np.shape(value) != self.system.u.shape:
            raise InvalidValue(
                "a displacement has three components for each node, in one row",
                where="Model.u",
                value=np.shape(value),
                cause="a row for each node, or the unknowns behind the displacement",
                remedy=f"shape {self.system.u.shape}; u.ravel() of rows",
            )
        if not np.isfinite(value).all():
            raise NotFinite(
                "a displacement must be finite",
                where="Model.u",
                value=f"component {int(np.flatnonzero(~np.isfinite(value))[0])}",
                cause="a division by zero",
                remedy="the displacement of a converged state",
            )
        self.system.u = value

    @property
    def positions(self) -> Floats:
        """Positions of the nodes in the converged state, shape (n, 3)."""
        return self.mesh.displaced(self.u)

    @property
    def state(self) -> State:
        """The present state: unknowns, time and values of the controls."""
        return self.system.state

    def remove(self, thing: Support | Contact) -> Load:
        """Remove a support or a contact; its forces remain as a dead load of factor 1.

        Move the load to zero to release the sheet gradually, see docs/supports.md. :class:`umform.Free` does both
        within a run, and opens tools that stay in the model.

        Parameters
        ----------
        thing : Support or Contact
            Return value of ``fix``, ``symmetry``, ``hinge``, ``hold_director`` or ``contact``. With a contact its
            controls are removed too.

        Returns
        -------
        Load
            The control of the forces.

        Raises
        ------
        InvalidValue
            If it does not belong to the model, or is already removed.
        """
        return removal.remove(self.system, thing)

    def unbalanced(self, name: str = "unbalanced") -> Load:
        """A load of the unbalanced forces at the present state, for an operation that begins there.

        Tools and supports of the previous operation, and metal that was cut off, exerted these forces. First add the
        supports and tools of the present operation. Move the load to zero for springback, see docs/operations.md.

        Parameters
        ----------
        name : str
            Column of the history: 1 as long as all of the forces act.

        Returns
        -------
        Load
            The control of the forces, of value 1.

        Raises
        ------
        InvalidValue
            If supports hold nodes away from their present positions, or the name is taken.
        """
        return removal.balancing(self.system, name)

    def put_back(self, thing: Support | Tool, *, here: bool = True) -> None:
        """Restore a removed support, or contact with an opened tool.

        Parameters
        ----------
        thing : Support or Tool
            The support or the tool.
        here : bool
            Hold the nodes of a support where they are now, not where they were in the undeformed mesh.
        """
        if isinstance(thing, Tool):
            put_tool_back(self.system, thing)
        else:
            removal.put_back(self.system, thing, here=here)

    def hold_rigid(
        self, nodes: Selector = "all", name: str = "", *, instead_of: Support | Sequence[Support] = ()
    ) -> Support:
        """Define a statically determinate support of the sheet, which a step Free activates.

        It holds the rigid-body modes that the supports of the model leave free, six at three nodes if there are none.
        It is inactive until ``Free(..., on=...)`` or :meth:`put_back`. Without other forces its reactions are zero.

        Parameters
        ----------
        nodes : str, callable or array_like
            Nodes that may be held: three that are not on a line, or more, of which distant ones are chosen.
        name : str, optional
            Name of the support.
        instead_of : Support or sequence of Support, optional
            Supports that the same step frees; their nodes may be held.

        Raises
        ------
        InvalidValue
            If the supports leave no mode free, the nodes cannot hold the sheet, or the name is taken.
        """
        everything = isinstance(nodes, str) and nodes == "all"
        ids = np.arange(len(self.mesh.points), dtype=np.int32) if everything else self.mesh.nodes(nodes)
        gone: Sequence[Support] = instead_of if isinstance(instead_of, Sequence) else [instead_of]
        dofs = gauge_dofs(self.system, ids, gone)
        return self.supports.wait(unique(dofs // 3).astype(np.int32), dofs, name)

    def rest(self, stiffness: Stiffness | None = None, name: str = "rest", *, motions: str = "") -> Rest:
        """Support a loose sheet by weak springs, removed for good once tools hold it.

        A run does so automatically, with the default stiffness, if tools that its steps move will hold the sheet. Set
        :attr:`carries_loose_sheet` to False to refuse such a model instead.

        Parameters
        ----------
        stiffness : float, optional
            Force per length of all springs together. Default: 1e-12 of the largest entry of the tangent.
        name : str
            Columns of the history: ``<name>_energy`` and ``<name>_acts``. A run warns if the springs still act at its
            end, or if their energy is more than 1e-6 of the work.
        motions : str
            For the note of a run: the rigid-body motions for which it added the springs.
        """
        if stiffness is None:
            stiffness = 1e-12 * self.system.largest_entry(self.evaluate(self.state).values)
        check_arguments(Model.rest, f"rest {name}", stiffness=stiffness)
        term = Rest(name, self.u, stiffness, motions)
        self.system.add(term)
        return term

    def keep_gap(self, force: ToolForce, to: Contact | Tool, gap: Gap) -> None:
        """Keep a gap between a pressed tool and another one: rigid distance blocks take the excess of its force.

        The force of the blocks is the column ``<name>_stop``: with the force of the sheet on the tool it balances the
        press. If the sheet pushes harder than the press, the tool lifts off the blocks.

        Parameters
        ----------
        force : ToolForce
            Return value of :meth:`press` or :meth:`spring` for the tool.
        to : Tool or Contact
            The other tool, or a pair that touches it; the pressed tool must follow its motions, see :meth:`attach`.
        gap : float
            Smallest distance between both, measured where they face each other across the sheet.

        Raises
        ------
        InvalidValue
            If the tools do not face each other, are already nearer, or move apart from each other.
        """
        other, press = self.tools.own(to), self.tools.press_of(force)
        check_arguments(Model.keep_gap, gap=gap)
        at, below = stop_at_gap(self.system, press, other, gap)
        self.tools.stop(force, at, below=below)
        press.gaps.append(other)

    def __reduce__(self) -> tuple[Any, ...]:
        """A model is sent to another process as its problem and its state."""
        if self._origin is None:
            raise InvalidValue(
                "a model that was built by hand cannot be sent to another process",
                where="Model",
                cause="its kernels, and functions of yours, live in this one",
                remedy="build it in the worker, or write it as a Problem: Problem.of(tables)",
            )
        return _built_again, (self._origin, self.system.snapshot())

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Old names, with a warning that says the new one."""
            return getattr(*moved(self, name))

        def __setattr__(self, name: str, value: Any) -> None:
            if name in MOVED:
                setattr(*moved(self, name), value)
            else:
                super().__setattr__(name, value)


def sent_as(model: Model, origin: Any) -> None:
    """Let a model be sent to another process: as its state, and as what built it by ``origin.build().model``."""
    model._origin = origin


def _built_again(origin: Any, state: Snapshot) -> Model:
    """The model of a problem in a state."""
    model: Model = origin.build().model
    model.system.restore(state)
    return model
