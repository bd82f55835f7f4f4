"""Materials as text, with six digits."""

from __future__ import annotations

from dataclasses import fields, is_dataclass

from umform.materials import CompiledLaw, Elastic, LinearVoce, Metal, Plastic, Swift, Table, Umat, UserLaw

#: What the first stress of a curve is; it lies below R of a tensile test.
_START = " (start of the curve)"


def material_text(material: object) -> str:
    """Law and constants of a material as text.

    Parameters
    ----------
    material : object
        A law of umform; for others, their ``str``.

    Returns
    -------
    str
        "J2: E = 210000, nu = 0.3, yield stress 160, linear hardening 500" for instance.
    """
    if isinstance(material, UserLaw):
        return f"user law: {material.name}"
    if isinstance(material, CompiledLaw | Umat):
        kind = "UMAT" if isinstance(material, Umat) else "compiled law"
        name = "" if material.name in ("UMAT", "compiled law") else f" {material.name}"
        return f"{kind}{name}, {len(material.properties)} properties, {len(material.initial)} state variables"
    if not isinstance(material, Elastic):
        return str(material)
    text = f"{type(material).__name__}: E = {material.E:.6g}, nu = {material.nu:.6g}"
    if not isinstance(material, Plastic):
        return text
    text += f", {hardening_text(material.hardening)}"
    if isinstance(material, Metal):
        parts = (material.yield_function, material.back_stress, material.modulus, material.rate)
        text += "".join(f", {_part_text(part)}" for part in parts if part is not None)
    return text


def _part_text(part: object) -> str:
    """A component of a metal with its constants."""
    if isinstance(part, float):
        return f"{part:.6g}"
    if isinstance(part, tuple):
        return f"({', '.join(map(_part_text, part))})"
    if not is_dataclass(part):
        return str(part)
    constants = ", ".join(
        f"{field.name} = {_part_text(getattr(part, field.name))}" for field in fields(part) if field.repr
    )
    return f"{type(part).__name__}({constants})" if constants else type(part).__name__


def hardening_text(curve: object) -> str:
    """A hardening curve: the initial yield stress, and its increase."""
    if isinstance(curve, LinearVoce):
        parts = [f"yield stress {curve.yield_stress:.6g}"]
        if curve.modulus:
            parts.append(f"linear hardening {curve.modulus:.6g}")
        if curve.rate and curve.saturation > curve.yield_stress:
            parts[0] += _START
            parts.append(f"saturation {curve.saturation:.6g} at the rate {curve.rate:.6g}")
        return ", ".join(parts) if len(parts) > 1 else f"{parts[0]}, perfectly plastic"
    if isinstance(curve, Swift):
        first = curve.strength * curve.offset**curve.exponent
        law = f"{curve.strength:.6g} ({curve.offset:.6g} + e)^{curve.exponent:.6g}"
        return f"yield stress {first:.6g}{_START}, Swift hardening {law}"
    if isinstance(curve, Table):
        end = f"{curve.stress[-1]:.6g} at a plastic strain of {curve.eqps[-1]:.6g}"
        return f"yield stress {curve.stress[0]:.6g}{_START}, table of {len(curve.eqps)} points up to {end}"
    return str(curve)
