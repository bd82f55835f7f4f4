"""One measured bend corrects the card of its metal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from umform.analysis.run import Result
from umform.errors import InvalidValue
from umform.materials import J2, Hardening, Metal, YoshidaUemori
from umform.processes.air_bending.goal import Goal, needed_stroke
from umform.processes.air_bending.outcome import outcome_of
from umform.processes.air_bending.problem import problem_of
from umform.processes.air_bending.remarks import coarse_mesh
from umform.processes.air_bending.spec import AirBending
from umform.progress import Show
from umform.spec import check_arguments, check_value
from umform.spec.types import Length, Positive
from umform.studies.identification import Identified, MeasuredNumber, Sought, identify

#: Bounds of the factor of the flow stress, and of the constant that gives the curve its shape, over that of the card.
_FACTOR, _SHAPE = (0.5, 2.0), (0.25, 4.0)
#: Usual standard deviations of measurements, as parts of them.
_USUAL = {"force": 0.01, "radius": 0.03}
#: Misfit in standard deviations that the notes name.
_FAR = 2.0
#: Constants of a curve that are stresses, and those that give curves their shape, the first that a curve has.
_STRESSES = ("strength", "yield_stress", "modulus", "saturation", "stress")
_SHAPES = ("exponent", "rate", "modulus")


@dataclass(frozen=True)
class Corrected:
    """A card that explains a measured bend.

    Attributes
    ----------
    law : J2 or Metal
        The corrected law.
    found : Identified
        Factor of the flow stress, and of the shape of the curve if the force was measured, with standard errors.
    case : AirBending
        The measured bend with the corrected law.
    notes : tuple of str
        What was corrected, and what was assumed.
    """

    law: J2 | Metal
    found: Identified
    case: AirBending
    notes: tuple[str, ...]


def correct(
    case: AirBending,
    angle: float,
    *,
    angle_deviation: Positive = 0.1,
    force: Positive | None = None,
    force_deviation: Positive | None = None,
    radius: Length | None = None,
    radius_deviation: Positive | None = None,
    name: str = "the card",
    progress: Show = None,
) -> Corrected:
    """Correct the flow curve of a metal by one measured bend.

    With the angle, the flow stress gets a factor. With the force, a second constant, which gives the curve its shape,
    is found as well: Swift's exponent, the rate of Voce, the modulus of a line.

    Parameters
    ----------
    case : AirBending
        The measured bend with its stroke, and the card.
    angle : float
        Measured angle between the legs after springback, in degrees.
    angle_deviation, force_deviation, radius_deviation : float
        Standard deviations; default: 0.1 degrees, 1 % of the force, 3 % of the radius.
    force : float, optional
        Measured force at the stroke, in kN/m.
    radius : float, optional
        Measured inside radius in mm.
    name : str
        Name of the card, for the notes.
    progress : bool, optional
        Show a progress bar for each run.

    Raises
    ------
    InvalidValue
        The case has no stroke, a measurement or deviation is not positive, the law has no flow curve with a scale, the
        measurements do not determine what is looked for, or no factor explains them.
    NoConvergence
        The first run does not converge.
    """
    check_arguments(correct, case=case, name=name)
    needed_stroke(case)
    check_value(Goal, "angle", angle)
    check_value(correct, "angle_deviation", angle_deviation)
    curve = case.material.hardening
    shape = _shape(curve, getattr(case.material, "back_stress", None))
    data = [_measured("angle", angle, angle_deviation, case)]
    others = {"force": (force, force_deviation), "radius": (radius, radius_deviation)}
    for measured, (value, deviation) in others.items():
        check_value(correct, measured, value)
        check_value(correct, f"{measured}_deviation", deviation)
        if value is not None:
            data.append(_measured(measured, value, _USUAL[measured] * value if deviation is None else deviation, case))
        elif deviation is not None:
            raise InvalidValue(
                "a standard deviation has no measurement",
                where=f"{measured}_deviation",
                value=deviation,
                cause=f"no {measured} beside it",
                remedy=f"give {measured}, or leave the deviation out",
            )
    sought: dict[str, Sought] = {"flow_stress": Sought(*_FACTOR, start=1.0)}
    if force is not None and shape:
        sought[shape] = Sought(*_SHAPE, start=1.0)
    options = problem_of(case).build().options

    def law(flow_stress: float, **shapes: float) -> J2 | Metal:
        return replace(case.material, hardening=_scaled(curve, flow_stress, shapes))

    def build(**factors: float) -> tuple[Any, Any]:
        made = problem_of(replace(case, material=law(**factors))).build()
        return made.model, made.steps

    found = identify(build, sought, data, options=options, progress=progress)
    _refuse_far(found)
    corrected = law(**found.values)
    return Corrected(corrected, found, replace(case, material=corrected), tuple(_notes(case, found, data, name)))


def _refuse_far(found: Identified) -> None:
    """Refuse a card that stays far from the measured bend with a factor at its bound."""
    ended = [path for path, deviation in found.deviations.items() if math.isinf(deviation)]
    if ended and found.fit.misfit > _FAR:
        raise InvalidValue(
            "no flow curve of this shape gives the measured bend",
            where=ended[0].replace("_", " "),
            value=f"{found.values[ended[0]]:.3g} times the card, {found.fit.misfit:.0f} standard deviations off",
            cause="another thickness, stroke or tool than the measured one, or an angle under load",
            remedy="compare them with the bend; or begin with the card of a nearer metal",
        )


def _scaled(curve: Hardening | None, flow_stress: float, shapes: Mapping[str, float]) -> Hardening:
    """The curve with stresses times a factor, and constants of its shape times theirs."""
    assert curve is not None
    changes: dict[str, Any] = {}
    for name, value in _given(curve).items():
        factor = (flow_stress if name in _STRESSES else 1.0) * shapes.get(name, 1.0)
        changes[name] = tuple(factor * one for one in value) if isinstance(value, tuple) else factor * value
    changes |= {name: value for name, value in _given(curve).items() if name == "eqps"}
    return replace(curve, **changes)  # type: ignore[type-var]


def _given(curve: Hardening) -> dict[str, Any]:
    return {one.name: getattr(curve, one.name) for one in fields(curve) if one.init}  # type: ignore[arg-type]


def _shape(curve: Hardening | None, back_stress: object = None) -> str:
    """The constant that gives a curve its shape; empty if it has none.

    Raises
    ------
    InvalidValue
        There is no curve with stresses, or it is part of a back stress.
    """
    names: dict[str, Any] = {} if curve is None or not is_dataclass(curve) else _given(curve)
    if not any(name in names for name in _STRESSES) or isinstance(back_stress, YoshidaUemori):
        raise InvalidValue(
            "this law has no flow curve that could be scaled",
            where="material",
            value=type(curve if back_stress is None else back_stress).__name__,
            cause="its hardening is part of its back stress, or a class of your own",
            remedy="a law with Swift, Voce, LinearVoce, Linear, Perfect or Table",
        )
    return next((name for name in _SHAPES if names.get(name)), "")


def _measured(name: str, value: float, deviation: float, case: AirBending) -> MeasuredNumber:
    def number(result: Result) -> float:
        return float(getattr(outcome_of(case, result).measures, name))

    number.__name__ = name
    return MeasuredNumber(number, value, deviation)


def _notes(case: AirBending, found: Identified, data: Sequence[MeasuredNumber], name: str) -> Iterator[str]:
    measured = ", ".join(f"{one.name} {one.value:g} +- {one.deviation:g}" for one in data)
    yield (
        f"{name}, corrected by one measured bend: {measured} at a stroke of {case.stroke:g} mm, T {case.thickness:g}, "
        f"V {case.opening:g}, punch {case.punch_radius:g}, shoulders {case.die_radius:g}"
    )
    for path, value in found.values.items():
        yield f"{path.replace('_', ' ')} times {value:.4f} +- {found.deviations[path]:.2g}"
    if case.friction:
        yield (
            "assumed: thickness, tools, elastic constants, back stresses, the rest of the law, "
            f"a friction of {case.friction:g}"
        )
    else:
        yield "assumed: thickness, tools, elastic constants, back stresses, the rest of the law, and no friction"
    yield from coarse_mesh(case)
    if len(data) == 1:
        yield "the angle alone does not tell stress from hardening: the forces of this card are wrong"
    if found.fit.misfit > _FAR:
        yield f"the corrected bend is {found.fit.misfit:.1f} standard deviations from the measurement"
