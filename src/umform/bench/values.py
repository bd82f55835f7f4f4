"""Values of a form, as the Specs take them; each that is not valid is an error with the name of its field."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping
from typing import Any

from umform.bench.form import LONGEST_STRIP, FormField
from umform.errors import InvalidValue
from umform.processes.bend_sequence import Bend
from umform.processes.bend_sequence.outside import OutsideBend, OutsidePart
from umform.spec import check_value, parameters

#: Largest number of bends of a part on the page, and of entries of a list.
_MOST_BENDS, _MOST_LISTED = 20, 40


class Mistakes(InvalidValue):
    """A form with invalid fields.

    Attributes
    ----------
    errors : list of InvalidValue
        One for each; ``where`` is the name of the field, or such as "bend 2, position".
    """

    def __init__(self, errors: list[InvalidValue]) -> None:
        first = errors[0]
        super().__init__(first.what, where=first.where, value=first.value, cause=first.cause, remedy=first.remedy)
        self.errors = errors


def value_of(one: FormField, value: Any) -> Any:
    """A value of a field as its Spec takes it.

    Raises
    ------
    InvalidValue
        If the Spec refuses it, or a length is larger than the server takes.
    """
    if value is None and one.may_be_empty:
        return None
    if one.kind == "bends":
        return _bends(value)
    if one.kind == "outside":
        return _outside(value)
    if one.many:
        return _list(one, value)
    return _single(one, value)


def _list(one: FormField, values: Any) -> list[Any]:
    """The entries of a list, each once; numbers in their order."""
    if not isinstance(values, list) or not 1 <= len(values) <= _MOST_LISTED or None in values:
        raise InvalidValue(
            f"this is no list of 1 to {_MOST_LISTED} entries",
            value=values,
            cause="an empty field, or text between the numbers",
            remedy="numbers with blanks between them, or first:last:step",
        )
    found = list(dict.fromkeys(_single(one, value) for value in values))
    return sorted(found) if one.kind == "numbers" else found


def _single(one: FormField, value: Any) -> Any:
    """A single value of a field."""
    if type(value) in (int, float) and one.parameter.about.unit == "mm" and value > one.most:
        raise InvalidValue(
            f"{one.said(one.parameter.subject)} is more than the bench takes",
            value=value,
            cause="another unit",
            remedy=f"at most {one.most:g} mm",
        )
    if one.double and type(value) in (int, float):
        return 2.0 * _checked(one.parameter.spec, one.parameter.name, 0.5 * _as_float(value))
    return _checked(one.parameter.spec, one.parameter.name, value)


def _checked(spec: type, name: str, value: Any) -> Any:
    """A value of JSON, which writes 2.0 as 2, after the check of the Spec."""
    kinds = {kind.type for kind in parameters(spec)[name].kinds}
    if type(value) is int and float in kinds:
        value = _as_float(value)
    check_value(spec, name, value)
    return value


def _as_float(value: float) -> float:
    """A number as a float; infinite beyond the largest one."""
    return float(value) if abs(value) <= sys.float_info.max else math.inf


def _bends(rows: Any, spec: type = Bend, needed: str = "position") -> list[dict[str, Any]]:
    """The bends of a part, each checked by its Spec."""
    if not isinstance(rows, list) or not 1 <= len(rows) <= _MOST_BENDS:
        raise InvalidValue(
            f"a part has 1 to {_MOST_BENDS} bends here",
            cause="no bend, or too many of them",
            remedy="add or delete rows of the table of bends",
        )
    found, errors, known = [], [], parameters(spec)
    for number, row in enumerate(rows, start=1):
        where = f"bend {number}"
        given: dict[str, Any] = {}
        if not isinstance(row, Mapping):
            errors.append(InvalidValue("a bend is an object with fields", where=where, value=row))
            continue
        errors += [unknown(f"{where}, {name}") for name in row if name not in known or name == "tools"]
        for name in (name for name in row if name in known and name != "tools"):
            try:
                if row[name] is not None or not known[name].absent:
                    given[name] = _checked(spec, name, row[name])
            except InvalidValue as error:
                error.where = f"{where}, {name}"
                errors.append(error)
        if needed not in row:
            angle = needed == "angle"
            what = "the angle of a bend is missing" if angle else "the position of a bend is missing"
            errors.append(InvalidValue(what, where=where, cause="an empty field", remedy=known[needed].remedy))
        found.append(given)
    if not errors:
        for number, given in enumerate(found, start=1):
            try:
                spec(**given)
            except InvalidValue as error:
                error.where = f"bend {number}"
                errors.append(error)
    if errors:
        raise Mistakes(errors)
    return found


def _outside(value: Any) -> dict[str, Any]:
    """Flanges and bends of a part by its outside dimensions."""
    if not isinstance(value, Mapping) or value.keys() != {"flanges", "bends"} or not isinstance(value["flanges"], list):
        raise InvalidValue("outside dimensions are an object with flanges and bends", value=value)
    errors: list[InvalidValue] = []
    flanges = [_flange(number, one, errors) for number, one in enumerate(value["flanges"][: _MOST_BENDS + 1], start=1)]
    try:
        bends = _bends(value["bends"], OutsideBend, "angle")
    except Mistakes as mistakes:
        errors += mistakes.errors
    if errors:
        raise Mistakes(errors)
    OutsidePart(tuple(flanges), tuple(OutsideBend(**bend) for bend in bends))
    return {"flanges": flanges, "bends": bends}


def _flange(number: int, value: Any, errors: list[InvalidValue]) -> float:
    """The outside length of a flange; an error of it is added to the others."""
    if type(value) in (int, float) and 0.0 < value <= LONGEST_STRIP:
        return float(value)
    errors.append(
        InvalidValue(
            "the outside length of a flange must be positive and finite",
            where=f"flange {number}",
            value=value,
            cause="a sign, or a missing value",
            remedy=f"at most {LONGEST_STRIP:g} mm",
        )
    )
    return 1.0


def unknown(name: object) -> InvalidValue:
    """Error for a field that the form does not have."""
    return InvalidValue(
        "the form has no such field",
        where=str(name)[:60],
        cause="a form of another version",
        remedy="load the page again",
    )


def unfit(values: Mapping[str, Any]) -> Iterator[InvalidValue]:
    """Goals and values of a coil that are missing, or given twice."""

    def given(*names: str) -> int:
        return sum(values.get(name) is not None for name in names)

    def not_one(what: str, first: str, second: str) -> Iterator[InvalidValue]:
        if (count := given(first, second)) != 1:
            cause, remedy = "none of them is given", "fill in one field"
            if count:
                cause, remedy = "both are given", "leave one of them out"
            yield InvalidValue(what, where=second, cause=cause, remedy=remedy)

    if values["work"] == "bottom":
        yield from not_one("give the force or the way beyond the bottom, one of them", "force_per_metre", "travel")
    if values["work"] == "bend":
        yield from not_one("give the angle or the stroke, one of them", "stroke", "angle")
    if values["work"] == "correct" and given("stroke", "measured_angle") != 2:
        yield InvalidValue(
            "a measured bend has a stroke and an angle",
            where="measured_angle" if given("stroke") else "stroke",
            cause="one of them is missing",
            remedy="fill in both fields",
        )
    if values["work"] == "flat" and not given("part"):
        yield InvalidValue("choose the part", where="part", remedy="a STEP file of one bent part")
    if given("yield_stress", "tensile_strength") == 1 or (given("uniform_elongation") and not given("yield_stress")):
        yield InvalidValue(
            "a coil has both, Re and Rm",
            where="yield_stress",
            cause="one of them is missing",
            remedy="both from the certificate, or neither: usual values of the metal",
        )
    elif given("yield_stress", "tensile_strength") == 2:
        yield from _exchanged(values["yield_stress"], values["tensile_strength"])


def _exchanged(re: float, rm: float) -> Iterator[InvalidValue]:
    """A yield stress that is not below the tensile strength."""
    if re >= rm:
        yield InvalidValue(
            f"Re {re:g} is not below Rm {rm:g}",
            where="yield_stress",
            cause="the two are exchanged, or one has another unit",
            remedy=f"Re {rm:g} and Rm {re:g}, if they are exchanged; both in MPa",
        )
