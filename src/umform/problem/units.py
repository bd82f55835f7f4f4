"""Check that stresses and lengths are in consistent units.

umform is independent of units, so all bounds are on ratios: first yield as a strain, the width over the thickness. Only
a sheet metal of the library, and ``umform bend``, fix them to mm and MPa. Values impossible for a metal sheet are
errors, unusual ones warnings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from umform.materials import SVK, Elastic, Plastic, Table
from umform.model import Model
from umform.model.contact.encounter import sheet_thickness
from umform.problem.findings import Finding, error, ok, warning

#: Young's modulus that is none in any unit.
_NO_STIFFNESS = 1e-100

#: Strain at first yield: metals have 3e-4 to 1e-2; beyond the outer pair, stresses are in different units.
_USUAL_YIELD, _POSSIBLE_YIELD = (1e-4, 3e-2), (1e-5, 0.2)
#: A sheet softer than this share of the stiffest is a foil of a polymer, whose first yield is at 1e-2 to 1e-1.
_SOFT, _USUAL_YIELD_OF_FOIL = 0.1, (1e-3, 0.15)
#: Plastic strain at the end of a table: curves are extrapolated to 1 or 2; a curve in per cent ends at 15 and more.
_USUAL_END, _POSSIBLE_END = 2.0, 5.0
#: In-plane extent of the sheet over its thickness.
_USUAL_EXTENT, _POSSIBLE_EXTENT = 0.1, 0.01
#: Young's modulus in MPa and thickness in mm, for solids that are formed as sheets.
_POSSIBLE_E, _POSSIBLE_THICKNESS = (1e3, 1e6), (1e-2, 1e2)
#: Young's moduli of metals in GPa, from lead to tungsten.
_METALS_IN_GPA = (10.0, 420.0)
#: Ratio of the penalty to the stiffness of the sheet across its thickness above which the tangent is ill-conditioned.
_STIFF = 100.0
#: The same above which forces of contact lose all digits; below its inverse there is no contact.
_TOO_STIFF = 1e12


def units(model: Model, *, millimetres: bool = False) -> Iterator[Finding]:
    """Check that stiffness, lengths, yield stress, hardening and penalties are in the same units.

    Parameters
    ----------
    model : Model
        The model, which is unchanged.
    millimetres : bool
        Units are known to be mm, N and MPa.
    """
    yield extent(model)
    materials: list[object] = [body.material for body in model.bodies]
    laws = [law for law in materials if isinstance(law, Elastic)]
    if not laws:
        return
    stiffest = max(laws, key=lambda law: law.E)  # a foil on a sheet may be as soft as rubber
    if softest := [law for law in laws if law.E < _NO_STIFFNESS]:
        yield error("units", f"E = {softest[0].E:.4g}: this is no stiffness", "E of steel is 210e3 MPa")
        return
    yield elastic_constants(model, stiffest, millimetres=millimetres)
    for material in materials:
        if isinstance(material, Plastic):
            yield from plastic_constants(material, foil=material.E < _SOFT * stiffest.E)
    thickness = sheet_thickness(model.mesh)
    for contact in model.contacts:
        ratio = contact.penalty * thickness / stiffest.E
        if ratio > _STIFF:
            remedy = "a softer penalty: expected pressure / penetration that you allow"
            level = error if ratio > _TOO_STIFF else warning
            yield level(f"contact {contact.name}", f"the penalty is {ratio:.3g} times E / thickness", remedy)
        elif ratio < 1.0 / _TOO_STIFF:
            remedy = "a stiffer penalty, or a smaller penetration that is allowed; or neither of them"
            yield error(f"contact {contact.name}", f"the penalty is {ratio:.3g} times E / thickness", remedy)


def extent(model: Model) -> Finding:
    """Length and width of the sheet against its thickness; in plane strain any width will do."""
    spans, thickness = np.ptp(model.positions, axis=0), sheet_thickness(model.mesh)
    sizes = " x ".join(f"{span:.4g}" for span in spans)
    held = model.supports.fixed.reshape(-1, 3).all(axis=0)
    ratio = float(spans[~held].min(initial=math.inf)) / thickness
    text = f"the sheet spans {sizes} at a thickness of {thickness:.4g}"
    if ratio >= _USUAL_EXTENT:
        return ok("sheet", text)
    text += f": a side of {ratio:.3g} thicknesses"
    remedy = "give length, width and thickness in one unit"
    return error("sheet", text, remedy) if ratio < _POSSIBLE_EXTENT else warning("sheet", text, remedy)


def elastic_constants(model: Model, material: Elastic, *, millimetres: bool) -> Finding:
    """Young's modulus against the size of the sheet, within the range of metals."""
    length, thickness = float(np.ptp(model.mesh.points, axis=0).max()), sheet_thickness(model.mesh)
    E = material.E
    text = f"E = {E:.4g}, thickness {thickness:.4g}, length {length:.4g}"
    if millimetres and not _POSSIBLE_E[0] <= E <= _POSSIBLE_E[1]:
        return error("units", f"{text}: stresses are in MPa here", "E of steel is 210e3, of aluminium 70e3")
    if millimetres and not _POSSIBLE_THICKNESS[0] <= thickness <= _POSSIBLE_THICKNESS[1]:
        return error("units", f"{text}: lengths are in mm here", "a sheet of 1 mm has the thickness 1.0")
    if E > 1e9 and length > 1.0:
        return warning("units", f"{text}: Pa with mm?", "with mm and N stresses are in MPa: E of steel is 210e3")
    if _METALS_IN_GPA[0] <= E <= _METALS_IN_GPA[1] and isinstance(material, Plastic | SVK) and length > 1.0:
        remedy = "with mm and N stresses are in MPa: E of steel is 210e3; with GPa forces are in kN"
        return warning("units", f"{text}: GPa with mm?", remedy)
    if 1e3 < E < 1e7 and length < 0.05 and not millimetres:
        return warning("units", f"{text}: MPa with m?", "with m and N stresses are in Pa: E of steel is 210e9")
    return ok("units", text)


def plastic_constants(material: Plastic, *, foil: bool = False) -> Iterator[Finding]:
    """Yield stress against Young's modulus, and the strains of a hardening table."""
    first, usual = first_yield(material), _USUAL_YIELD_OF_FOIL if foil else _USUAL_YIELD
    strain = first / material.E
    text = f"first yield at a strain of {strain:.3g}: yield stress {first:.4g}, E = {material.E:.4g}"
    remedy = "give yield stress and elastic constants in one unit"
    if not _POSSIBLE_YIELD[0] <= strain <= _POSSIBLE_YIELD[1]:
        yield error("units", text, remedy)
    elif not usual[0] <= strain <= usual[1]:
        yield warning("units", text, remedy)
    curve = material.hardening
    if isinstance(curve, Table) and curve.eqps[-1] > _USUAL_END:
        text = f"the hardening curve ends at a plastic strain of {curve.eqps[-1]:.4g}: per cent?"
        remedy = "plastic strains are no per cent: write 0.2 for 20 %"
        yield (error if curve.eqps[-1] > _POSSIBLE_END else warning)("material", text, remedy)


def first_yield(material: Plastic) -> float:
    """Yield stress of the virgin material."""
    return material.hardening.curve()(0.0)[0]
