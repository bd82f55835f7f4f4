"""Fingerprints: texts that identify the input of a run.

A text has names and numbers to the last digit, and digests of arrays and functions. A function is identified by its
code, defaults and closure, not by its module, because an imported script has another name; a class of the user by the
code of its methods, one of umform by its name, since two runs share the version.
"""

from __future__ import annotations

import dataclasses
import enum
import hashlib
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import PurePath
from types import CodeType
from typing import Any

import numpy as np

import umform
from umform.analysis.newton.newton import Newton
from umform.digest import digest
from umform.model import Model, Term, Tool
from umform.model.contact import Contact
from umform.model.supports.support import Support
from umform.model.terms.control import Control

_DEEPEST = 8


def fingerprint(model: Model, steps: Sequence[object], newton: Newton, frames: int) -> dict[str, str]:
    """Input that two runs must share to give the same bits, part by part.

    Parameters
    ----------
    model : Model
        The model, at any state.
    steps : sequence of Step
        Steps of the run.
    newton : Newton
        Its options and its solver.
    frames : int
        Number of states to keep for pictures.
    """
    mesh = model.mesh
    supports = [
        np.flatnonzero(model.supports.constrained()),
        [(tie.dofs, tie.control) for tie in model.supports.ties],
        [(part.dofs, part.weights, part.control, part.offsets) for part in model.supports.rows],
        [(support.name, support.base) for support in model.supports if support.base is not None],
        [(support.name, support.held) for support in model.supports.all if support.waits],
    ]
    return {
        "version of umform": umform.__version__,
        "mesh": f"{mesh.cell}, {len(mesh.points)} points, {len(mesh.connectivity)} cells, "
        + digest(mesh.points, mesh.connectivity),
        "element": text([[body.element, body.thickness_points, body.thickness_rule] for body in model.bodies]),
        "material": text([[body.name, body.material, body.rolling] for body in model.bodies]),
        "bodies": text([None if body.whole else body.cells for body in model.bodies]),
        "supports and loads": text([supports, [_control(control) for control in model.controls]]),
        "contacts": text([_contact(contact) for contact in model.contacts]),
        "tools": text([_tool(tool) for tool in model.tools]),
        "other terms": text([_term(term) for term in model.system.others]),
        "steps": text(list(steps)),
        "options": text(newton.options),
        "solver": newton.solver,
        "frames": str(frames),
    }


def text(value: object, depth: int = 0) -> str:
    """A value as text that is the same in every process."""
    if depth > _DEEPEST:
        return "..."
    inner = partial(text, depth=depth + 1)
    if isinstance(value, enum.Enum):
        return str(value)
    if isinstance(value, np.generic):  # a NumPy float is also a float
        return repr(value.item())
    if value is None or isinstance(value, str | bool | int | float | complex | bytes):
        return repr(value)
    if isinstance(value, PurePath):
        return repr(str(value))
    if isinstance(value, np.ndarray):
        return f"array {value.shape} {digest(value)}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(inner(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{inner(key)}: {inner(item)}" for key, item in value.items()) + "}"
    if isinstance(value, Control | Support):  # a rank has a part of it
        return value.name
    if isinstance(value, Term):
        return value.key
    name = type(value).__qualname__
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        entries = [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value) if field.compare]
        own = _is_of(type(value), umform.__name__)
        code = "" if own else f" {_digest(_methods(type(value), depth))}"
        return f"{name}{code}({', '.join(f'{key}={inner(item)}' for key, item in entries)})"
    if isinstance(value, type) or getattr(value, "__code__", None) or getattr(value, "__func__", None):
        return _function(value, depth)
    if isinstance(value, partial):
        return inner([value.func, value.args, value.keywords])
    return _object(value, depth)


def _object(value: object, depth: int = 0) -> str:
    """Class of an object with the code of its methods, and its attributes: two objects of one class may differ."""
    kind = type(value)
    held = dict(sorted(getattr(value, "__dict__", {}).items()))
    methods = _methods(kind, depth)
    if not held and not methods:
        return getattr(value, "__qualname__", kind.__qualname__)  # of a library, in C for instance
    return f"{kind.__qualname__} {_digest([held, methods], depth + 1)}"


def _methods(kind: type, depth: int) -> list[str]:
    """Names and digests of the methods of a class and of its bases but those of Python, properties among them."""
    bases = (base for base in kind.__mro__ if not _is_of(base, *sys.stdlib_module_names))
    parts = [part for base in bases for _, part in sorted(vars(base).items())]
    written = [getattr(part, name, None) for part in parts for name in ("__func__", "fget", "func")]
    return [_function(one, depth) for one in [*parts, *written] if hasattr(one, "__code__")]


def _is_of(kind: type, *packages: str) -> bool:
    return kind.__module__.partition(".")[0] in packages


def _digest(value: object, depth: int = 0) -> str:
    return hashlib.sha256(text(value, depth).encode()).hexdigest()[:32]


def _control(control: Control) -> str:
    """All attributes of a control but its value."""
    entries = {name: value for name, value in vars(control).items() if name != "value"}
    return f"{type(control).__qualname__} {text(entries)}"


def _contact(contact: Contact) -> str:
    return text(
        [
            contact.name,
            contact.tool.name,
            contact.facets,
            contact.points,
            contact.cells,
            contact.initial_penalty,
            contact.allowed,
            contact.augmented,
            *([] if contact.law is None else [contact.law]),
        ]
    )


def _tool(tool: Tool) -> str:
    moved = [tool.ways, tool.motion, tool.reference_point]
    presses = [[press.way, press.force, press.stiffness, press.free, press.stops] for press in tool.presses]
    return text([tool.name, tool.surface, *moved, presses])


def _term(term: Term) -> str:
    """All constant attributes of a term, and the code of its class."""
    entries = {name: value for name, value in vars(term).items() if name not in term.memory}
    return f"{type(term).__qualname__} {text([entries, _methods(type(term), 0)])}"


def _function(function: Any, depth: int) -> str:
    """Name and digest of a function or of a method with its object, or the name of a class."""
    owner = getattr(function, "__self__", None)
    function = getattr(function, "__func__", function)
    code = getattr(function, "__code__", None)
    if code is None:
        return getattr(function, "__qualname__", type(function).__qualname__)
    enclosed = [_content(cell) for cell in function.__closure__ or ()]
    parts = [_code(code), function.__defaults__, function.__kwdefaults__, enclosed, owner]
    return f"{function.__name__} {_digest(parts, depth + 1)}"


def _code(code: CodeType) -> list[object]:
    constants = [_code(constant) if isinstance(constant, CodeType) else constant for constant in code.co_consts]
    return [code.co_code, code.co_names, constants]


def _content(cell: Any) -> object:
    try:
        return cell.cell_contents
    except ValueError:  # empty so far
        return None
