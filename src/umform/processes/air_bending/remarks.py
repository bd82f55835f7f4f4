"""Remarks on the numbers of a bend: tools in use, coarse mesh, force for the press, extrapolated curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from umform.elements import element
from umform.processes.air_bending.formulas import shop_forces, uniform_strain
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.spec import AirBending
from umform.results.quantity import Quantity

#: Deviation of the computed force from the workshop formula that is explained.
_APART = 0.15
#: Standard gravity in m/s², for forces in tonnes.
_GRAVITY = 9.80665
#: Ways of the punch, which are no results of the mesh.
STROKES = ("stroke", "below_die")


def tools_text(case: AirBending) -> str:
    """The tools in use, those that nobody has given too."""
    die, punch = case.sizes("die"), case.sizes("punch")
    v = f"V {die['opening']:g}, {die['angle']:g} degrees, shoulder {die['radius']:g}"
    tip = f"punch radius {punch['radius']:g}, {punch['angle']:g} degrees"
    return f"tools: {v}, {tip}; V/t {case.opening / case.thickest:.3g}"


def depth_text(below_die: float) -> str:
    """Where the machine holds the punch at the stroke: the depth of its tip below the top of the die, or its height."""
    side = "below" if below_die >= 0.0 else "above"
    return f"for the machine: the tip of the punch {abs(below_die):.3f} mm {side} the top of the die"


#: Settings of the mesh beside their defaults.
_SETTINGS = {
    "elements_per_thickness": "elements per thickness {:g} (default {:g})",
    "layers": "layers {:g} (default {:g})",
    "width_elements": "width elements {:g} (default {:g})",
}


def coarse_mesh(case: AirBending, like: AirBending | None = None) -> list[str]:
    """Remarks if the mesh is coarser than a default one, or has other elements than the studies of errors."""
    like = like or AirBending()
    names = [name for name in _SETTINGS if name != "width_elements" or case.width is not None]
    pairs = {name: (getattr(case, name), getattr(like, name)) for name in names}
    below = [_SETTINGS[name].format(own, usual) for name, (own, usual) in pairs.items() if own < usual]
    found = []
    if below:
        found.append(
            f"coarse mesh: {', '.join(below)}; for a trial only, the angle may be off by some degrees; force, "
            "springback and thinning are those of this mesh"
        )
    made = element(case.element)
    if made.cell != element(like.element).cell:
        found.append(
            f"the numbers have no bands: the studies of errors have elements like {like.element}, none like {made.name}"
        )
    return found


def of_this_mesh(case: AirBending, quantities: Sequence[Quantity], like: AirBending | None = None) -> list[Quantity]:
    """Numbers of a bend; on a mesh coarser than that of `like` those without an error are marked, but for strokes."""
    coarse = bool(coarse_mesh(case, like))
    return [replace(one, of_mesh=coarse and one.band is None and one.name not in STROKES) for one in quantities]


def extrapolated(case: AirBending, outer_strain: float) -> list[str]:
    """A remark if the outer strain exceeds the strain up to which the flow curve is known."""
    known = uniform_strain(case.material, 0.0 if case.rolling is None else 90.0 - case.rolling)
    if not 0.0 < known < outer_strain:
        return []
    places = 2 if f"{known:.2f}" != f"{outer_strain:.2f}" else 4
    return [
        f"the outer strain {outer_strain:.{places}f} exceeds the {known:.{places}f} up to which a tensile test "
        "supports the flow curve: it is extrapolated there"
    ]


def force_apart(case: AirBending, measures: Measures) -> list[str]:
    """A remark if the maximum of the force is far from the workshop formula, which holds for air bending."""
    force, middle = measures.largest_force, 0.5 * sum(shop_forces(case))
    passed = measures.force < force  # before the maximum the formula does not apply
    if case.bottoming or not passed or not middle or abs(force / middle - 1.0) <= _APART:
        return []
    off = f"{100.0 * abs(force / middle - 1.0):.0f}"
    if force > middle:
        return [f"the computed force is {off} % above the rule of the shop: choose the press by the larger value"]
    return [
        f"the computed force is {off} % below the rule of the shop, which includes friction and the higher Rm of real "
        "coils: choose the press by the larger value"
    ]


def remarks(case: AirBending, measures: Measures) -> list[str]:
    """All remarks on a single bend."""
    return [*coarse_mesh(case), *force_apart(case, measures), *extrapolated(case, measures.outer_strain)]


def total_force(force: float, length: float) -> str:
    """A force in kN/m on a bend length in mm, in kN and tonnes."""
    whole = force * length / 1e3
    return f"largest force on a bend length of {length:g} mm: {whole:.4g} kN ({whole / _GRAVITY:.3g} t)"
