"""The state of a formed part written for other programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from umform.errors import InvalidValue
from umform.io.atomic import PendingFile
from umform.io.states.abaqus import abaqus_lines, calculix_lines, read_initial_conditions
from umform.io.states.dynain import dynain_lines, read_dynain
from umform.io.states.radioss import radioss_lines, read_radioss
from umform.io.states.state import FormedState
from umform.model import Model
from umform.report.symmetry import mirrors
from umform.results.formed import Points, Rule, formed_shells, formed_solids

if TYPE_CHECKING:
    from umform.model.transfer.trim import AtItsEnd


class Program(NamedTuple):
    """A file format.

    Attributes
    ----------
    lines : callable
        The lines of the file of a state.
    read : callable
        The state in a file.
    suffix : str
        Of its files.
    meshes : tuple of str
        Meshes that it has, the default first.
    points : {1, 8}
        Points of a solid.
    rule : {"gauss", "even"}
        Rule of the points of a shell.
    """

    lines: Callable[[FormedState], Iterator[str]]
    read: Callable[[Path], FormedState]
    suffix: str
    meshes: tuple[str, ...]
    points: Points = 1
    rule: Rule = "gauss"


#: The formats by name.
PROGRAMS = {
    "dynain": Program(dynain_lines, read_dynain, ".k", ("shells", "solids")),
    "radioss": Program(radioss_lines, read_radioss, ".sta", ("shells", "solids"), rule="even"),
    "abaqus": Program(abaqus_lines, read_initial_conditions, ".inp", ("solids",)),
    "calculix": Program(calculix_lines, read_initial_conditions, ".inp", ("solids",), 8),
}
#: Points of a shell, layers of solids.
POINTS, LAYERS = 9, 6


def export_state(
    part: Model | AtItsEnd,
    path: str | PathLike[str],
    to: str = "dynain",
    *,
    mesh: str | None = None,
    points: int = POINTS,
    layers: int = LAYERS,
    mirror: bool = False,
    units: str = "",
) -> FormedState:
    """Write the present state of a part for another program: mesh, thickness, stresses, plastic strains.

    Keywords, order of points and limits: docs/other-programs.md.

    Parameters
    ----------
    part : Model or Result
        A model in a converged state, or a run, whose last state it is.
    path : str or PathLike
        The file.
    to : {"dynain", "radioss", "abaqus", "calculix"}
        LS-DYNA, OpenRadioss, Abaqus or CalculiX.
    mesh : {"shells", "solids"}, optional
        Shells on the middle surface, or layers of solids; default shells, solids for Abaqus and CalculiX.
    points : int
        Points through the thickness of shells, 2 to 20.
    layers : int
        Layers of solids through each cell, 1 to 40.
    mirror : bool
        Whether to add the mirror images at the planes of symmetry of the supports.
    units : str
        Units, for the head of the file; numbers are not converted.

    Returns
    -------
    FormedState
        What was written.

    Raises
    ------
    InvalidValue
        If there is nothing to write, or an argument is invalid; no file is written then.
    FileProblem
        If the file cannot be written.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(160.0, 500.0))
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=steel)
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> result = uf.solve(model, uf.Move(tip, to=-2.0, steps=4), progress=False)
    >>> state = uf.export_state(result, "part.k", units="mm, N, MPa")  # doctest: +SKIP
    """
    if not isinstance(part, Model) and not isinstance(getattr(part, "model", None), Model):
        raise InvalidValue(
            "what is exported is a model or its run",
            where="part",
            value=type(part).__name__,
            cause="a mesh, or a file, in place of them",
            remedy="the result of solve(), or its model",
        )
    program = PROGRAMS.get(to)
    if program is None:
        raise InvalidValue(
            "unknown program",
            where="to",
            value=to,
            cause="a typing error, or another program",
            remedy="one of " + ", ".join(PROGRAMS),
        )
    wanted = mesh or program.meshes[0]
    if wanted not in program.meshes:
        raise InvalidValue(
            f"the format {to} has no such mesh", where="mesh", value=wanted, remedy=" or ".join(program.meshes)
        )
    model = part if isinstance(part, Model) else part.model
    said = units or "those of the model"
    if wanted == "shells":
        state = formed_shells(model, points, said, program.rule)
    else:
        state = formed_solids(model, layers, program.points, said)
    if mirror:
        state = _whole(model, state)
    with PendingFile(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"{line}\n" for line in program.lines(state))
    return state


def read_state(path: str | PathLike[str], to: str = "dynain") -> FormedState:
    """Read a file that :func:`export_state` has written.

    Parameters
    ----------
    path : str or PathLike
        The file.
    to : {"dynain", "radioss", "abaqus", "calculix"}
        Its format.

    Raises
    ------
    FileProblem
        If the file cannot be read.

    Examples
    --------
    >>> from umform.report.state_files import read_state
    >>> state = read_state("part.k")  # doctest: +SKIP
    """
    return PROGRAMS[to].read(Path(path))


def _whole(model: Model, state: FormedState) -> FormedState:
    """The state of the whole part."""
    planes = mirrors(model)
    if not planes:
        raise InvalidValue(
            "the supports have no plane of symmetry",
            where="mirror",
            cause="the whole part is modelled, or the supports of this stage hold it otherwise",
            remedy="leave mirror out",
        )
    for plane in planes:
        state = state.mirrored(plane.axis, plane.at)
    return state
