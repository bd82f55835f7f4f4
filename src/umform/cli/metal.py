"""The law of a sheet from options of the command line: a metal of the library, or constants."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

from umform.cli.options import SHEET, option
from umform.cli.root import say
from umform.cli.spec_options import in_place_of
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.materials import J2, Hardening, Metal

#: What is computed with if no material is given.
_NO_MATERIAL = "the sheet is a soft steel like DC04; forces and springback of another metal differ much"


@contextmanager
def by_name(where: str, otherwise: str = "") -> Iterator[None]:
    """Name place and commands in errors of the library of sheet metals."""
    try:
        yield
    except InvalidValue as error:
        if error.where == "sheet_metals":
            error.where = where
            error.cause = error.cause or "a typing mistake, or a metal that the library does not have"
            error.remedy = f"choose one of `umform metal list`{otherwise}"
        raise


@dataclass(frozen=True)
class SheetMetal:
    """The metal of a sheet as it is typed: a name, or the constants of a law."""

    material: Annotated[
        str | None,
        option(
            "Name in the library of sheet metals (`umform metal list`), or a file such as fit/metal.toml.",
            SHEET,
            "--material",
            "-m",
        ),
    ]
    young: Annotated[float | None, option("Young's modulus in MPa.", SHEET)]
    poisson: Annotated[float | None, option("Poisson's ratio.", SHEET)]
    yield_stress: Annotated[float | None, option("Yield stress in MPa, for linear hardening.", SHEET)]
    hardening_modulus: Annotated[float | None, option("Hardening modulus in MPa; default 0.", SHEET)]
    curve: Annotated[
        str | None,
        option(
            "Hardening curve, such as Swift,520,0.004,0.22 or Voce,180,330,14, in MPa; numbers alone are those of "
            "Swift.",
            SHEET,
            "--curve",
            "--swift",
        ),
    ]
    flow_curve: Annotated[
        Path | None, option("Measured hardening: a CSV file of plastic strain and true stress.", SHEET)
    ]

    @by_name("--material", ", or --yield-stress, --curve or --flow-curve of a certificate in its place")
    def law(self, thickness: float) -> tuple[J2 | Metal, str]:
        """Law of a sheet of a thickness in mm, and a remark on it; a warning if no material is given."""
        from umform.processes.air_bending.spec import dc04_like

        own = any(getattr(self, one.name) is not None for one in fields(self) if one.name != "material")
        if self.material is not None:
            if own:
                raise InvalidValue(
                    "give a material by name or by numbers",
                    where="--material",
                    value=self.material,
                    cause="an option of a law of your own, such as --yield-stress or --curve, beside the name",
                    remedy="leave one of them out; `umform metal show NAME` lists the numbers of a name",
                )
            from umform.problem.metal_file import metal_of

            try:
                metal = metal_of(self.material, thickness)
            except InvalidValue as error:
                error.where = "--thickness" if error.where == "get, thickness" else error.where
                raise
            return metal.law, metal.note
        if not own:
            say(f"warning: no --material: {_NO_MATERIAL}")
            return dc04_like(), f"material: {_NO_MATERIAL}"
        return self._own_law(), ""

    def _own_law(self) -> J2:
        from umform.materials import J2, Linear, Perfect
        from umform.sheet_metals import read_flow_curve

        linear = self.yield_stress is not None or self.hardening_modulus is not None
        ways = [linear, self.curve is not None, self.flow_curve is not None]
        if ways.count(True) != 1 or (linear and self.yield_stress is None):
            raise InvalidValue(
                "a hardening curve is given by --yield-stress with --hardening-modulus, by --curve, or by --flow-curve",
                where="--yield-stress",
                cause="two of them are given, or none beside --young, --poisson or --hardening-modulus",
                remedy="--yield-stress 160 --hardening-modulus 500, --curve Swift,520,0.004,0.22, "
                "or --flow-curve coil.csv",
            )
        hardening: Hardening
        if self.curve is not None:
            hardening = _curve(self.curve)
        elif self.flow_curve is not None:
            hardening = read_flow_curve(self.flow_curve)
        else:
            assert self.yield_stress is not None
            with _asked_by("--yield-stress, --hardening-modulus"):
                modulus = self.hardening_modulus
                hardening = Linear(self.yield_stress, modulus) if modulus else Perfect(self.yield_stress)
        with _asked_by("--young, --poisson"):
            young, poisson = 210e3 if self.young is None else self.young, 0.3 if self.poisson is None else self.poisson
            return J2(E=young, nu=poisson, hardening=hardening)


def with_metal(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options of the metal; its parameter ``metal`` gets them."""
    options = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=hint)
        for name, hint in get_type_hints(SheetMetal, include_extras=True).items()
    ]
    made: Callable[..., Any] = in_place_of("metal", options, lambda values: SheetMetal(**values))(command)
    return made


def _curve(text: str) -> Hardening:
    """A curve by its name and numbers, in the order of its fields; numbers alone are those of Swift."""
    from umform.materials.hardening import Hardening
    from umform.materials.known import known
    from umform.spec import parameters

    of_numbers = {
        name: list(parameters(kind))
        for name, kind in known(Hardening).items()
        if all(one.kinds[0].type is float for one in parameters(kind).values())
    }
    name, _, rest = text.partition(",")
    with suppress(ValueError):
        float(name)
        name, rest = "Swift", text
    word = next((word for word in of_numbers if word.lower() == name.lower()), None)
    if word is None:
        raise InvalidValue(
            "no hardening curve of this name is given by numbers",
            where="--curve",
            value=name,
            cause="a typing mistake, or a curve of points",
            remedy=f"one of {', '.join(of_numbers)}; --flow-curve for points",
        )
    fields = of_numbers[word]
    how = f"{word},{','.join(fields).replace('_', ' ')}, such as --curve Swift,520,0.004,0.22"
    with _asked_by("--curve"):
        made: Hardening = known(Hardening)[word](*numbers(rest, ",", len(fields), "--curve", how))
    return made


@contextmanager
def _asked_by(options: str) -> Iterator[None]:
    """Name the options instead of the law in errors."""
    try:
        yield
    except InvalidValue as error:
        error.where = options
        raise


def numbers(text: str, separator: str, count: int, where: str, remedy: str) -> list[float]:
    """Numbers with a separator between them; any other number of them is refused."""
    try:
        values = [float(part) for part in text.split(separator)]
    except ValueError:
        values = []
    if len(values) != count:
        raise InvalidValue(
            f"{count} numbers are needed here",
            where=where,
            value=text,
            cause=f"{len(values)} numbers are given" if values else "no numbers, or another sign between them",
            remedy=remedy,
        )
    return values
