"""umform: solid-shell finite elements for sheet-metal bending and forming, with exact contact to rigid tools."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from umform import errors

if TYPE_CHECKING:
    from umform import elements, mesh, processes, sheet_metals, surfaces
    from umform._core import set_threads, threads
    from umform.elements import Element, Term, Tying
    from umform.errors import UmformError
    from umform.materials import (
        J2,
        SVK,
        Chaboche,
        CompiledLaw,
        CowperSymonds,
        FallingModulus,
        Hill48,
        Hosford,
        JohnsonCook,
        Linear,
        LinearVoce,
        LogarithmicSpace,
        Metal,
        Mises,
        NeoHooke,
        NeoHookePower,
        Perfect,
        Swift,
        Table,
        Transformation,
        Umat,
        UserLaw,
        Voce,
        Yld91,
        Yld2004,
        YoshidaUemori,
        check_law,
    )
    from umform.mesh import Mesh
    from umform.model import Body, Model
    from umform.model.axes import cylindrical, turned
    from umform.model.contact.friction import Friction, FrictionByRegion, Region
    from umform.model.element_check import check_element
    from umform.model.trim import Trim
    from umform.results import fields
    from umform.run import Result, resume, solve
    from umform.run.stages import Stage, solve_stages
    from umform.solution.options import NewtonOptions
    from umform.steps import Arc, Close, Free, Move, Pace, Release
    from umform.studies.sweep import Sweep, sweep
    from umform.surfaces import (
        Box,
        Cylinder,
        Extruded,
        LedAround,
        Plane,
        Profile,
        Punch,
        Revolved,
        Sphere,
        Torus,
        Triangulated,
        UDie,
        UserSurface,
        VDie,
        WipingDie,
        check_surface,
        read_tool,
        write_tool,
    )

__version__ = "0.1.0"

_HOME = {
    "umform._core": ("set_threads", "threads"),
    "umform.elements": ("Element", "Term", "Tying", "rolling_at"),
    "umform.errors": ("UmformError",),
    "umform.materials": (
        "Chaboche",
        "CompiledLaw",
        "CowperSymonds",
        "FallingModulus",
        "Hill48",
        "Hosford",
        "JohnsonCook",
        "LogarithmicSpace",
        "Metal",
        "Mises",
        "Transformation",
        "Yld91",
        "YoshidaUemori",
        "Yld2004",
        "J2",
        "SVK",
        "Linear",
        "LinearVoce",
        "NeoHooke",
        "NeoHookePower",
        "Perfect",
        "Swift",
        "Table",
        "Umat",
        "UserLaw",
        "Voce",
        "check_law",
    ),
    "umform.mesh": ("Mesh",),
    "umform.model": ("Body", "Model"),
    "umform.model.axes": ("cylindrical", "turned"),
    "umform.model.contact.friction": ("Friction", "FrictionByRegion", "Region"),
    "umform.model.element_check": ("check_element",),
    "umform.model.trim": ("Trim",),
    "umform.run": ("Result", "resume", "solve"),
    "umform.run.stages": ("Stage", "solve_stages"),
    "umform.solution.options": ("NewtonOptions",),
    "umform.steps": ("Arc", "Close", "Free", "Move", "Pace", "Release"),
    "umform.surfaces": (
        "Box",
        "Cylinder",
        "Extruded",
        "LedAround",
        "Plane",
        "Profile",
        "Punch",
        "Revolved",
        "Sphere",
        "Torus",
        "Triangulated",
        "UDie",
        "UserSurface",
        "VDie",
        "WipingDie",
        "check_surface",
        "read_tool",
        "write_tool",
    ),
    "umform.studies.sweep": ("Sweep", "sweep"),
}
_MODULES = {
    "elements": "umform.elements",
    "fields": "umform.results.fields",
    "mesh": "umform.mesh",
    "processes": "umform.processes",
    "sheet_metals": "umform.sheet_metals",
    "surfaces": "umform.surfaces",
}
_HOME_OF = {name: module for module, names in _HOME.items() for name in names}

__all__ = [
    "J2",
    "SVK",
    "Arc",
    "Body",
    "Box",
    "Chaboche",
    "Close",
    "CompiledLaw",
    "CowperSymonds",
    "Cylinder",
    "Element",
    "Extruded",
    "FallingModulus",
    "Free",
    "Friction",
    "FrictionByRegion",
    "Hill48",
    "Hosford",
    "JohnsonCook",
    "LedAround",
    "Linear",
    "LinearVoce",
    "LogarithmicSpace",
    "Mesh",
    "Metal",
    "Mises",
    "Model",
    "Move",
    "NeoHooke",
    "NeoHookePower",
    "NewtonOptions",
    "Pace",
    "Perfect",
    "Plane",
    "Profile",
    "Punch",
    "Region",
    "Release",
    "Result",
    "Revolved",
    "Sphere",
    "Stage",
    "Sweep",
    "Swift",
    "Table",
    "Term",
    "Torus",
    "Transformation",
    "Triangulated",
    "Trim",
    "Tying",
    "UDie",
    "Umat",
    "UmformError",
    "UserLaw",
    "UserSurface",
    "VDie",
    "Voce",
    "WipingDie",
    "Yld91",
    "Yld2004",
    "YoshidaUemori",
    "check_element",
    "check_law",
    "check_surface",
    "cylindrical",
    "elements",
    "errors",
    "fields",
    "mesh",
    "processes",
    "read_tool",
    "resume",
    "rolling_at",
    "set_threads",
    "sheet_metals",
    "solve",
    "solve_stages",
    "surfaces",
    "sweep",
    "threads",
    "turned",
    "write_tool",
]


def __getattr__(name: str) -> object:
    """Import a public name when it is first used, so that `import umform` is quick."""
    if name in _HOME_OF:
        value = getattr(importlib.import_module(_HOME_OF[name]), name)
    elif name in _MODULES:
        value = importlib.import_module(_MODULES[name])
    else:
        raise AttributeError(f"module 'umform' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
