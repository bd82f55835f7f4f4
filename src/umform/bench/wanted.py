"""The values of a form, and the parameters of the process that follow from them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.bench.choices import Choices, Measured
from umform.bench.form import ABOUT_K, BY_MESH, DRAW_MESHES, DRAWS, HEM_MESHES, MANY, MESHES, SECOND, WORKS, form_fields
from umform.bench.shelf import KINDS, Shelf
from umform.bench.titles import title_of
from umform.bench.values import Mistakes, unfit, unknown, value_of
from umform.errors import InvalidValue
from umform.io.store import Store
from umform.materials import J2, Metal
from umform.processes.air_bending.bottoming import with_travel
from umform.processes.air_bending.goal import Goal, check_angle
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import StackedSheet
from umform.processes.bend_sequence import Bend, BendSequence
from umform.processes.bend_sequence.outside import OutsideBend, OutsidePart
from umform.processes.draw.cup import Cup
from umform.processes.draw.u_bend import UBend
from umform.processes.hemming import Hemming

if TYPE_CHECKING:
    from umform.flat_pattern import Tooling
    from umform.flat_pattern.developed import Developed
    from umform.studies.bend_table import Setup

#: Most bends of a table.
_MOST_OF_TABLE = 1000


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
        """The values of a form; fields that are not given have their defaults.

        Those of other work, and of a second sheet without a metal, are left out.

        Raises
        ------
        Mistakes
            With one error for each invalid field.
        """
        if not isinstance(form, Mapping):
            raise Mistakes([InvalidValue("a form is an object with fields", where="form", value=form)])
        known = form_fields()
        errors = [unknown(name) for name in form if name not in known]
        work = form.get("work", known["work"].default)
        alone = form.get(f"{SECOND}material") is None
        values: dict[str, Any] = {}
        for name, one in known.items():
            if alone and one.parameter.spec is StackedSheet:
                continue
            if work in one.works or work not in WORKS:
                try:
                    values[name] = value_of(one, form.get(name, one.default))
                except Mistakes as mistakes:
                    errors += mistakes.errors
                except InvalidValue as error:
                    error.where = name
                    errors.append(error)
        errors = errors or list(unfit(values))
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
        """Fields of the form that belong to the bench."""
        return Choices(**self.of(Choices))

    @cached_property
    def goal(self) -> Goal:
        """Angle, force or way that is wanted."""
        return Goal(**self.of(Goal))

    @property
    def measured(self) -> Measured:
        """Measurements of the bend."""
        return Measured(**self.of(Measured))

    @property
    def of_coil(self) -> bool:
        """Whether the values of a coil are given."""
        return self.choices.yield_stress is not None

    def law(self, thickness: float | None = None) -> tuple[J2 | Metal, str]:
        """Law of the sheet, and a note on its source; the thickness is that of the form, or of a part."""
        from umform.sheet_metals import get, of_certificate

        own = self.choices
        thickness = self.values.get(f"{own.work}_thickness", thickness)
        try:
            if own.yield_stress is None or own.tensile_strength is None:
                metal = get(own.material, self.values.get("thickness", thickness))
            else:
                elongation = None if own.uniform_elongation is None else 0.01 * own.uniform_elongation
                metal = of_certificate(own.material, own.yield_stress, own.tensile_strength, elongation)
        except InvalidValue as error:
            error.where = {"sheet_metals": "material", "": "tensile_strength"}.get(error.where, error.where)
            raise
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

    def cases(self, shelf: Shelf) -> list[Any]:
        """Cases of the processes that are run, as far as they are known before; those of a part are not."""
        if self.choices.work == "flat":
            return []
        if self.choices.work == "table":
            return [setup.case for setup in self.setups()]
        if self.is_drawn:
            return [self.draw()]
        case = self.case(shelf)
        return [self.strip(case) if self.of_strip else case]

    def at_tools(self, shelf: Shelf | None = None) -> AirBending:
        """Parameters of the bend, whatever angle is wanted."""
        drawn: dict[str, Any] = {
            f"{kind}_section": (shelf or Shelf(Path())).tool(kind, name)
            for kind, name in self.drawn.items()
            if name is not None
        }
        meshes = HEM_MESHES if self.choices.work == "hem" else MESHES
        given = meshes[self.choices.mesh] | self.of(AirBending) | drawn
        case = AirBending(
            **given,
            width=self.choices.length if self.choices.whole else None,
            bottoming=self.choices.work == "bottom",
            material=self.law()[0],
            on_top=self.on_top,
        )
        return case if self.goal.travel is None else with_travel(case, self.goal.travel)

    @property
    def on_top(self) -> tuple[StackedSheet, ...]:
        """The second sheet, if there is one.

        Raises
        ------
        InvalidValue
            ``where`` is the name of the field.
        """
        from umform.sheet_metals import get

        metal = self.choices.second_material
        if metal is None:
            return ()
        given = self.of(StackedSheet)
        try:
            return (StackedSheet(**given, material=get(metal, given["thickness"]).law),)
        except InvalidValue as error:
            error.where = SECOND + {"sheet_metals": "material"}.get(error.where, error.where)
            raise

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
        return self.choices.work in ("outside", "sequence", "hem")

    def strip(self, sheet: AirBending) -> BendSequence | Hemming:
        """The bends of a part, or the hem."""
        return self.hem(sheet) if self.choices.work == "hem" else self.sequence(sheet)

    def sequence(self, sheet: AirBending) -> BendSequence:
        """The bends in one part; of outside dimensions, at the bend lines that are known without a run."""
        if self.choices.work == "outside":
            return self.developed_at_once(sheet).sequence(sheet)
        given = self.of(BendSequence)
        return BendSequence(**given | {"bends": tuple(Bend(**row) for row in given["bends"])}, sheet=sheet)

    @property
    def outside(self) -> OutsidePart:
        """The part by its outside dimensions."""
        given = self.values["outside"]
        bends = tuple(OutsideBend(**row) for row in given["bends"])
        return OutsidePart(tuple(given["flanges"]), bends, self.values["acute"])

    def developed_at_once(self, sheet: AirBending) -> Developed:
        """Flat length and bend lines of outside dimensions without a run: from stored bends, or by a K-factor."""
        from umform.flat_pattern import KFactor
        from umform.flat_pattern.developed import developed_at_once

        return developed_at_once(self.outside, sheet, KFactor(ABOUT_K), Store())

    def developed(self, sheet: AirBending) -> Developed:
        """The same from computed bends; those that are not stored are run."""
        from umform.flat_pattern.developed import developed

        return developed(self.outside, sheet)

    @property
    def is_drawn(self) -> bool:
        """Whether a part is drawn."""
        return self.choices.work in DRAWS

    def draw(self) -> Cup | UBend:
        """The part that is drawn.

        Raises
        ------
        InvalidValue
            ``where`` is the name of the field.
        """
        work = self.choices.work
        fields = {name: one for name, one in form_fields().items() if one.parameter.spec is DRAWS[work]}
        given = dict(DRAW_MESHES[work][self.choices.mesh])
        for name, one in fields.items():
            value = self.values[name]
            if value is not None or name not in BY_MESH:
                given[one.parameter.name] = 0.5 * value if one.double and value is not None else value
        names = {one.parameter.name: name for name, one in fields.items()}
        try:
            return DRAWS[work](**given, material=self.law(given["thickness"])[0])
        except InvalidValue as error:
            name = names.get(error.where, error.where)
            if name in fields and fields[name].double and isinstance(error.value, int | float):
                error.value = 2.0 * error.value
            error.where = name
            raise

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
        return title_of(self.values, self.goal)
