"""umform: solid-shell finite elements for sheet-metal bending and forming, with exact contact to rigid tools."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING

from umform import errors as errors
from umform.renamed import Moved, refuse

if TYPE_CHECKING:
    from umform import elements as elements
    from umform import materials as materials
    from umform import mesh as mesh
    from umform import processes as processes
    from umform import sheet_metals as sheet_metals
    from umform import surfaces as surfaces
    from umform._core import threads as threads
    from umform.analysis.newton.options import NewtonOptions as NewtonOptions
    from umform.analysis.run import Result as Result
    from umform.analysis.run import resume as resume
    from umform.analysis.run import solve as solve
    from umform.analysis.run.open_run import OpenRun as OpenRun
    from umform.analysis.run.stages import Stage as Stage
    from umform.analysis.run.stages import solve_stages as solve_stages
    from umform.analysis.steps import Arc as Arc
    from umform.analysis.steps import Close as Close
    from umform.analysis.steps import Free as Free
    from umform.analysis.steps import Move as Move
    from umform.analysis.steps import Pace as Pace
    from umform.analysis.steps import Release as Release
    from umform.elements import Element as Element
    from umform.elements import Mode as Mode
    from umform.elements import Tying as Tying
    from umform.errors import UmformError as UmformError
    from umform.flat_pattern import flat as flat
    from umform.flat_pattern.one_step import Blank as Blank
    from umform.flat_pattern.one_step import BlankEstimate as BlankEstimate
    from umform.flat_pattern.one_step import blank as blank
    from umform.flat_pattern.one_step import corrected_blank as corrected_blank
    from umform.flat_pattern.one_step import mid_surface as mid_surface
    from umform.materials import *
    from umform.mesh import Mesh as Mesh
    from umform.model import Body as Body
    from umform.model import Model as Model
    from umform.model.contact.friction import Friction as Friction
    from umform.model.contact.friction import FrictionByRegion as FrictionByRegion
    from umform.model.contact.friction import Region as Region
    from umform.model.contact.own_law import CompiledContactLaw as CompiledContactLaw
    from umform.model.contact.own_law import ContactLaw as ContactLaw
    from umform.model.contact.own_law import check_contact_law as check_contact_law
    from umform.model.element_check import check_element as check_element
    from umform.model.supports.axes import cylindrical as cylindrical
    from umform.model.supports.axes import turned as turned
    from umform.model.transfer.trim import Trim as Trim
    from umform.report.state_files import export_state as export_state
    from umform.results import fields as fields
    from umform.studies.derivatives import Derivatives as Derivatives
    from umform.studies.derivatives import derivatives as derivatives
    from umform.studies.goals import Compensated as Compensated
    from umform.studies.goals import CompensatedShape as CompensatedShape
    from umform.studies.goals import Wanted as Wanted
    from umform.studies.goals import compensate as compensate
    from umform.studies.goals import compensate_shape as compensate_shape
    from umform.studies.identification import Identified as Identified
    from umform.studies.identification import MeasuredCurve as MeasuredCurve
    from umform.studies.identification import MeasuredNumber as MeasuredNumber
    from umform.studies.identification import Sought as Sought
    from umform.studies.identification import identify as identify
    from umform.studies.scatter import Scatter as Scatter
    from umform.studies.scatter import Scattered as Scattered
    from umform.studies.scatter import scatter as scatter
    from umform.studies.slopes import Slopes as Slopes
    from umform.studies.slopes import slopes as slopes
    from umform.studies.sweep import Sweep as Sweep
    from umform.studies.sweep import sweep as sweep
    from umform.surfaces import Box as Box
    from umform.surfaces import Cylinder as Cylinder
    from umform.surfaces import Extruded as Extruded
    from umform.surfaces import LedAround as LedAround
    from umform.surfaces import OffsetField as OffsetField
    from umform.surfaces import Plane as Plane
    from umform.surfaces import Profile as Profile
    from umform.surfaces import Punch as Punch
    from umform.surfaces import Revolved as Revolved
    from umform.surfaces import Sphere as Sphere
    from umform.surfaces import Torus as Torus
    from umform.surfaces import Triangulated as Triangulated
    from umform.surfaces import UDie as UDie
    from umform.surfaces import UserSurface as UserSurface
    from umform.surfaces import VDie as VDie
    from umform.surfaces import WipingDie as WipingDie
    from umform.surfaces import check_surface as check_surface
    from umform.surfaces import read_tool as read_tool
    from umform.surfaces import write_tool as write_tool
    from umform.thread_count import set_threads as set_threads

__version__ = "0.2.0"

sys.meta_path.append(Moved())

_HOME = {
    "umform._core": ("threads",),
    "umform.thread_count": ("set_threads",),
    "umform.elements": ("Element", "Mode", "Tying", "rolling_at"),
    "umform.errors": ("UmformError",),
    "umform.mesh": ("Mesh",),
    "umform.model": ("Body", "Model"),
    "umform.model.supports.axes": ("cylindrical", "turned"),
    "umform.model.contact.friction": ("Friction", "FrictionByRegion", "Region"),
    "umform.model.contact.own_law": ("CompiledContactLaw", "ContactLaw", "check_contact_law"),
    "umform.model.element_check": ("check_element",),
    "umform.model.transfer.trim": ("Trim",),
    "umform.analysis.run": ("Result", "resume", "solve"),
    "umform.analysis.run.open_run": ("OpenRun",),
    "umform.analysis.run.stages": ("Stage", "solve_stages"),
    "umform.analysis.newton.options": ("NewtonOptions",),
    "umform.analysis.steps": ("Arc", "Close", "Free", "Move", "Pace", "Release"),
    "umform.surfaces": (
        "Box",
        "Cylinder",
        "Extruded",
        "LedAround",
        "OffsetField",
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
    "umform.report.state_files": ("export_state",),
    "umform.flat_pattern": ("flat",),
    "umform.flat_pattern.one_step": ("Blank", "BlankEstimate", "blank", "corrected_blank", "mid_surface"),
    "umform.studies.derivatives": ("Derivatives", "derivatives"),
    "umform.studies.goals": ("Compensated", "CompensatedShape", "Wanted", "compensate", "compensate_shape"),
    "umform.studies.scatter": ("Scatter", "Scattered", "scatter"),
    "umform.studies.identification": ("Identified", "MeasuredCurve", "MeasuredNumber", "Sought", "identify"),
    "umform.studies.slopes": ("Slopes", "slopes"),
    "umform.studies.sweep": ("Sweep", "sweep"),
}
_MODULES = {
    "elements": "umform.elements",
    "errors": "umform.errors",
    "fields": "umform.results.fields",
    "materials": "umform.materials",
    "mesh": "umform.mesh",
    "processes": "umform.processes",
    "sheet_metals": "umform.sheet_metals",
    "surfaces": "umform.surfaces",
}
#: Packages whose classes are public without a line here.
_SEARCHED = ("umform.surfaces",)
_HOME_OF = {name: module for module, names in _HOME.items() for name in names}


def __getattr__(name: str) -> object:
    """Import a public name when it is first used, so that `import umform` is quick."""
    if name in _HOME_OF:
        value = getattr(importlib.import_module(_HOME_OF[name]), name)
    elif name in _MODULES:
        value = importlib.import_module(_MODULES[name])
    elif name == "__all__":
        return __dir__()
    elif name in _materials():
        value = getattr(importlib.import_module("umform.materials"), name)
    elif (found := _in_a_file(name)) is not None:
        value = found
    else:
        refuse(name)
        raise AttributeError(f"module 'umform' has no attribute {name!r}")
    globals()[name] = value
    return value


def _in_a_file(name: str) -> object:
    """A class of a package whose files are searched; None if there is none."""
    packages = (importlib.import_module(package) for package in _SEARCHED if name[:1].isupper())
    return next((found for package in packages if (found := getattr(package, name, None)) is not None), None)


def __dir__() -> list[str]:
    return sorted([*_HOME_OF, *_MODULES, *_materials()])


def _materials() -> Iterable[str]:
    """Names of materials; a new class there is a new name here."""
    names: Iterable[str] = importlib.import_module("umform.materials").public()
    return names
