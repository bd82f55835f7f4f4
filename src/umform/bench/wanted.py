"""What the form of the page asks for, and the parameters of the process that follow from it."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.bench.form import MANY, MESHES, WORKS, Choices, FormField, Measured, form_fields
from umform.bench.shelf import KINDS, Shelf
from umform.errors import InvalidValue
from umform.materials import J2, Metal
from umform.processes.air_bending.bottoming import with_travel
from umform.processes.air_bending.goal import Goal, check_angle
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence import Bend, BendSequence
from umform.processes.hemming import Hemming
from umform.spec import check_value, parameters

if TYPE_CHECKING:
    from umform.flat_pattern import Tooling
    from umform.studies.bend_table import Setup

#: Largest number of bends of a part on the page, of entries of a list, and of bends of a table.
_MOST_BENDS, _MOST_LISTED, _MOST_OF_TABLE = 20, 40, 1000


#: Most letters of the title of a bend table.
_LONGEST_TITLE = 120


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


@dataclass(frozen=True)
class Wanted:
    """A bend, or several, in mm, degrees and MPa.

    Attributes
    ----------
    values : mapping of str to object
        Values of the fields of this kind of work, as JSON; see `form_fields`.
    """

    values: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def read(cls, form: object) -> Wanted:
        """The values of a form; fields that are not given have their defaults, those of other work are left out.

        Raises
        ------
        Mistakes
            With one error for each invalid field.
        """
        if not isinstance(form, Mapping):
            raise Mistakes([InvalidValue("a form is an object with fields", where="form", value=form)])
        known = form_fields()
        errors = [_unknown(name) for name in form if name not in known]
        work = form.get("work", known["work"].default)
        values: dict[str, Any] = {}
        for name, one in known.items():
            if work in one.works or work not in WORKS:
                try:
                    values[name] = _value(one, form.get(name, one.default))
                except Mistakes as mistakes:
                    errors += mistakes.errors
                except InvalidValue as error:
                    error.where = name
                    errors.append(error)
        errors = errors or list(_unfit(values))
        if errors:
            raise Mistakes(errors)
        follow = {name: known[name].times for name, value in values.items() if value is None}
        return cls(values | {name: times * values["thickness"] for name, times in follow.items() if times is not None})

    def of(self, spec: type) -> dict[str, Any]:
        """The values of the parameters of a Spec by their names; what is empty has its default."""
        return {
            one.parameter.name: self.values[name]
            for name, one in form_fields().items()
            if one.parameter.spec is spec and not one.many and self.values.get(name) is not None
        }

    @cached_property
    def choices(self) -> Choices:
        """What the bench asks itself."""
        return Choices(**self.of(Choices))

    @cached_property
    def goal(self) -> Goal:
        """Angle, force or way that is wanted."""
        return Goal(**self.of(Goal))

    @property
    def measured(self) -> Measured:
        """What was measured of a bend."""
        return Measured(**self.of(Measured))

    @property
    def of_coil(self) -> bool:
        """Whether the values of a coil are given."""
        return self.choices.yield_stress is not None

    def law(self, thickness: float | None = None) -> tuple[J2 | Metal, str]:
        """Law of the sheet, and a note on its source; the thickness is that of the form, or of a part."""
        from umform.sheet_metals import get, of_certificate

        own = self.choices
        if own.yield_stress is None or own.tensile_strength is None:
            metal = get(own.material, self.values.get("thickness", thickness))
        else:
            elongation = None if own.uniform_elongation is None else 0.01 * own.uniform_elongation
            metal = of_certificate(own.material, own.yield_stress, own.tensile_strength, elongation)
        return metal.law, metal.note

    def case(self, shelf: Shelf | None = None) -> AirBending:
        """Parameters of the bend; an angle that the tools cannot reach is refused.

        Parameters
        ----------
        shelf : Shelf, optional
            Where drawn tools are.

        Raises
        ------
        InvalidValue
            ``where`` is the name of the parameter.
        """
        if self.choices.work == "table":
            return self.setups()[0].case
        case = self.at_tools(shelf)
        if self.of_strip:
            self.strip(case)
        elif self.goal.angle is not None:
            check_angle(case, self.goal.angle)
        return case

    def at_tools(self, shelf: Shelf | None = None) -> AirBending:
        """Parameters of the bend, whatever angle is wanted."""
        drawn: dict[str, Any] = {
            f"{kind}_section": (shelf or Shelf(Path())).tool(kind, name)
            for kind, name in self.drawn.items()
            if name is not None
        }
        given = MESHES[self.choices.mesh] | self.of(AirBending) | drawn
        case = AirBending(
            **given,
            width=self.choices.length if self.choices.whole else None,
            bottoming=self.choices.work == "bottom",
            material=self.law()[0],
        )
        return case if self.goal.travel is None else with_travel(case, self.goal.travel)

    def sheet(self) -> AirBending:
        """Mesh and tools of the bends of a part or of a table; sizes that follow from them have their defaults."""
        return AirBending(**MESHES[self.choices.mesh] | self.of(AirBending))

    def tooling(self, thickness: float) -> Tooling:
        """Metal and tools of the bends of a part."""
        from umform.flat_pattern import Tooling
        from umform.sheet_metals import get

        law, _ = self.law(thickness)
        opening = self.values["die_opening"]
        if self.of_coil:
            return Tooling(replace(self.sheet(), material=law), opening=opening)
        return Tooling(self.sheet(), get(self.choices.material, thickness).name, opening)

    def setups(self) -> list[Setup]:
        """Sheets and tools of a bend table; angles that they cannot have are refused.

        Raises
        ------
        InvalidValue
            ``where`` is the name of the field.
        """
        from umform.sheet_metals import get
        from umform.studies.bend_table import setups
        from umform.studies.bend_table.stored import check_bend

        values, lists = self.values, {many: self.values[many] for many in MANY.values()}
        count = math.prod(len(values[name]) for name in (*lists, "metals", "angles"))
        if count > _MOST_OF_TABLE:
            raise InvalidValue(
                f"a bend table has at most {_MOST_OF_TABLE} bends here",
                where="angles",
                value=count,
                cause="all combinations of the lists are bent",
                remedy="shorter lists, or several tables",
            )
        try:
            metals = [get(name).name for name in values["metals"]]  # of the library, no file
            found = setups(metals, self.sheet(), **lists)
        except InvalidValue as error:
            error.where = {**MANY, "sheet_metals": "metals"}.get(error.where, error.where)
            raise
        for setup in found:
            for angle in values["angles"]:
                try:
                    check_bend(setup.case, angle)
                except InvalidValue as error:
                    error.where = "angles"
                    error.value = f"{setup.name}, {angle:g}"
                    raise
        return found

    @property
    def of_strip(self) -> bool:
        """Whether a whole strip is modelled, in place of half of a bend."""
        return self.choices.work in ("sequence", "hem")

    def strip(self, sheet: AirBending) -> BendSequence | Hemming:
        """The bends of a part, or the hem."""
        return self.hem(sheet) if self.choices.work == "hem" else self.sequence(sheet)

    def sequence(self, sheet: AirBending) -> BendSequence:
        """The bends in one part."""
        given = self.of(BendSequence)
        return BendSequence(**given | {"bends": tuple(Bend(**row) for row in given["bends"])}, sheet=sheet)

    def hem(self, sheet: AirBending) -> Hemming:
        """The hem."""
        try:
            return Hemming(**self.of(Hemming), sheet=sheet)
        except InvalidValue as error:
            names = {one.parameter.name: name for name, one in form_fields().items() if one.parameter.spec is Hemming}
            error.where = names.get(error.where, error.where)
            raise

    @property
    def drawn(self) -> dict[str, str | None]:
        """Names of the drawn tools."""
        return {kind: self.values.get(kind) for kind in KINDS}

    def changed(self, changes: Mapping[str, Any]) -> Wanted:
        """The same form with other values."""
        return Wanted({**self.values, **changes})

    def as_ordered(self, case: AirBending) -> Wanted:
        """The same with the sizes of its drawn tools."""
        return self.changed(case.drawn_sizes)

    @property
    def title(self) -> str:
        """A few words for lists."""
        values, goal, work = self.values, self.goal, self.choices.work
        if work == "flat":
            return f"{values['part']}, {self.choices.material}"
        if work == "table":
            sheets = f"{', '.join(values['metals'])}, {_listed(values['thicknesses'])} mm"
            return f"{sheets}, V{_listed(values['openings'])}, {_listed(values['angles'])}°"[:_LONGEST_TITLE]
        sheet = f"{self.choices.material} {values['thickness']:g} mm"
        if work == "sequence":
            angles = [f"{row['angle']:g}°" for row in values["bends"] if "angle" in row]
            return f"{sheet}, {' '.join(angles)}"
        if work == "hem":
            return f"{sheet}, hem {values['gap']:g} mm"
        if work == "correct":
            return f"{sheet}, V{values['opening']:.4g}, measured {values['measured_angle']:g}°"
        if work == "bottom":
            aim = f"{goal.force_per_metre:g} kN/m" if goal.force_per_metre is not None else f"{goal.travel:+g} mm"
        else:
            aim = f"{goal.angle:g}°" if goal.angle is not None else f"{values['stroke']:g} mm"
        return f"{sheet}, V{values['opening']:.4g}, {aim}"


def _value(one: FormField, value: Any) -> Any:
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
    if one.many:
        return _list(one, value)
    return _single(one, value)


def _list(one: FormField, values: Any) -> list[Any]:
    """The entries of a list, each once; numbers in their order."""
    if not isinstance(values, list) or not 1 <= len(values) <= _MOST_LISTED:
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
    value = _checked(one.parameter.spec, one.parameter.name, value)
    if one.parameter.about.unit == "mm" and value > one.most:
        raise InvalidValue(
            f"{one.parameter.subject} is more than the bench takes",
            value=value,
            cause="another unit",
            remedy=f"at most {one.most:g} mm",
        )
    return value


def _checked(spec: type, name: str, value: Any) -> Any:
    """A value of JSON, which writes 2.0 as 2, after the check of the Spec."""
    kinds = {kind.type for kind in parameters(spec)[name].kinds}
    if type(value) is int and float in kinds:
        value = float(value) if abs(value) <= sys.float_info.max else math.inf
    check_value(spec, name, value)
    return value


def _bends(rows: Any) -> list[dict[str, Any]]:
    """The bends of a part, each checked by its Spec."""
    if not isinstance(rows, list) or not 1 <= len(rows) <= _MOST_BENDS:
        raise InvalidValue(f"a part has 1 to {_MOST_BENDS} bends here", cause="no bend, or too many of them")
    found, errors, known = [], [], parameters(Bend)
    for number, row in enumerate(rows, start=1):
        where = f"bend {number}"
        given: dict[str, Any] = {}
        if not isinstance(row, Mapping):
            errors.append(InvalidValue("a bend is an object with fields", where=where, value=row))
            continue
        errors += [_unknown(f"{where}, {name}") for name in row if name not in known or name == "tools"]
        for name in (name for name in row if name in known and name != "tools"):
            try:
                if row[name] is not None or not known[name].absent:
                    given[name] = _checked(Bend, name, row[name])
            except InvalidValue as error:
                error.where = f"{where}, {name}"
                errors.append(error)
        if "position" not in row:
            errors.append(InvalidValue("the position of a bend is missing", where=where))
        found.append(given)
    if not errors:
        for number, given in enumerate(found, start=1):
            try:
                Bend(**given)
            except InvalidValue as error:
                error.where = f"bend {number}"
                errors.append(error)
    if errors:
        raise Mistakes(errors)
    return found


def _listed(values: list[float]) -> str:
    return " ".join(f"{value:.4g}" for value in values)


def _unknown(name: object) -> InvalidValue:
    return InvalidValue("the form has no such field", where=str(name)[:60], cause="a form of another version")


def _unfit(values: Mapping[str, Any]) -> Iterator[InvalidValue]:
    """Goals and values of a coil that are missing, or given twice."""

    def given(*names: str) -> int:
        return sum(values.get(name) is not None for name in names)

    if values["work"] == "bottom" and given("force_per_metre", "travel") != 1:
        yield InvalidValue("give the force or the way beyond the bottom, one of them", where="travel")
    if values["work"] == "bend" and given("angle", "stroke") != 1:
        yield InvalidValue("give the angle or the stroke, one of them", where="angle")
    if values["work"] == "correct" and given("stroke", "measured_angle") != 2:
        yield InvalidValue(
            "a measured bend has a stroke and an angle",
            where="measured_angle" if given("stroke") else "stroke",
            cause="one of them is missing",
        )
    if values["work"] == "flat" and not given("part"):
        yield InvalidValue("choose the part", where="part", remedy="a STEP file of one bent part")
    if given("yield_stress", "tensile_strength") == 1 or (given("uniform_elongation") and not given("yield_stress")):
        yield InvalidValue("a coil has both, Re and Rm", where="yield_stress")
