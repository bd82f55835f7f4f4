"""umform: solid-shell finite elements for sheet-metal bending and forming, with exact contact to rigid tools."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from umform import errors

if TYPE_CHECKING:
    from umform import elements, fields, mesh, processes, sheet_metals, surfaces
    from umform._core import set_threads, threads
    from umform.arc import Arc
    from umform.elements import Element, Term, Tying
    from umform.errors import UmformError
    from umform.materials import (
        J2,
        SVK,
        Linear,
        LinearVoce,
        NeoHooke,
        NeoHookePower,
        Perfect,
        Swift,
        Table,
        Voce,
    )
    from umform.mesh import Mesh
    from umform.model import Model
    from umform.newton import NewtonOptions
    from umform.release import Release
    from umform.results import Result
    from umform.steps import Move, resume, solve
    from umform.surfaces import (
        Box,
        Cylinder,
        Extruded,
        Plane,
        Profile,
        Punch,
        Revolved,
        Sphere,
        Torus,
        UDie,
        UserSurface,
        VDie,
        WipingDie,
        check_surface,
        write_tool,
    )
    from umform.user_law import UserLaw, check_law

__version__ = "0.1.0"

_HOME = {
    "umform._core": ("set_threads", "threads"),
    "umform.arc": ("Arc",),
    "umform.elements": ("Element", "Term", "Tying"),
    "umform.errors": ("UmformError",),
    "umform.materials": (
        "J2",
        "SVK",
        "Linear",
        "LinearVoce",
        "NeoHooke",
        "NeoHookePower",
        "Perfect",
        "Swift",
        "Table",
        "Voce",
    ),
    "umform.mesh": ("Mesh",),
    "umform.model": ("Model",),
    "umform.newton": ("NewtonOptions",),
    "umform.results": ("Result",),
    "umform.release": ("Release",),
    "umform.steps": ("Move", "resume", "solve"),
    "umform.surfaces": (
        "Box",
        "Cylinder",
        "Extruded",
        "Plane",
        "Profile",
        "Punch",
        "Revolved",
        "Sphere",
        "Torus",
        "UDie",
        "UserSurface",
        "VDie",
        "WipingDie",
        "check_surface",
        "write_tool",
    ),
    "umform.user_law": ("UserLaw", "check_law"),
}
_MODULES = ("elements", "fields", "mesh", "processes", "sheet_metals", "surfaces")
_HOME_OF = {name: module for module, names in _HOME.items() for name in names}

__all__ = [
    "J2",
    "SVK",
    "Arc",
    "Box",
    "Cylinder",
    "Element",
    "Extruded",
    "Linear",
    "LinearVoce",
    "Mesh",
    "Model",
    "Move",
    "NeoHooke",
    "NeoHookePower",
    "NewtonOptions",
    "Perfect",
    "Plane",
    "Profile",
    "Punch",
    "Release",
    "Result",
    "Revolved",
    "Sphere",
    "Swift",
    "Table",
    "Term",
    "Torus",
    "Tying",
    "UDie",
    "UmformError",
    "UserLaw",
    "UserSurface",
    "VDie",
    "Voce",
    "WipingDie",
    "check_law",
    "check_surface",
    "elements",
    "errors",
    "fields",
    "mesh",
    "processes",
    "resume",
    "set_threads",
    "sheet_metals",
    "solve",
    "surfaces",
    "threads",
    "write_tool",
]


def __getattr__(name: str) -> object:
    """Import a public name when it is first used, so that `import umform` is quick."""
    if name in _HOME_OF:
        value = getattr(importlib.import_module(_HOME_OF[name]), name)
    elif name in _MODULES:
        value = importlib.import_module(f"umform.{name}")
    else:
        raise AttributeError(f"module 'umform' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
