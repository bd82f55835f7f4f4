"""The law of a sheet from options of the command line: a metal of the library, or constants."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import typer

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


@by_name("--material", ", or --yield-stress, --curve or --flow-curve of a certificate in its place")
def law_of(
    name: str | None,
    young: float | None,
    poisson: float | None,
    yield_stress: float | None,
    modulus: float | None,
    curve: str | None,
    flow_curve: Path | None,
    thickness: float,
) -> tuple[J2 | Metal, str]:
    """Law of the sheet of a thickness in mm, and a remark on it; a warning if no material is given."""
    from umform.processes.air_bending.spec import dc04_like

    own = [value for value in (young, poisson, yield_stress, modulus, curve, flow_curve) if value is not None]
    if name is not None:
        if own:
            raise InvalidValue(
                "give a material by name or by numbers",
                where="--material",
                value=name,
                cause="an option of a law of your own, such as --yield-stress or --curve, beside the name",
                remedy="leave one of them out; `umform metal show NAME` lists the numbers of a name",
            )
        from umform.problem.metal_file import metal_of

        metal = metal_of(name, thickness)
        return metal.law, metal.note
    if not own:
        typer.echo(f"umform: warning: no --material: {_NO_MATERIAL}", err=True)
        return dc04_like(), f"material: {_NO_MATERIAL}"
    return _own_law(young, poisson, yield_stress, modulus, curve, flow_curve), ""


def _own_law(
    young: float | None,
    poisson: float | None,
    yield_stress: float | None,
    modulus: float | None,
    curve: str | None,
    flow_curve: Path | None,
) -> J2:
    from umform.materials import J2, Linear, Perfect
    from umform.sheet_metals import read_flow_curve

    E, nu = 210e3 if young is None else young, 0.3 if poisson is None else poisson
    linear = yield_stress is not None or modulus is not None
    if [linear, curve is not None, flow_curve is not None].count(True) != 1 or (linear and yield_stress is None):
        raise InvalidValue(
            "a hardening curve is given by --yield-stress with --hardening-modulus, by --curve, or by --flow-curve",
            where="--yield-stress",
            cause="two of them are given, or none beside --young, --poisson or --hardening-modulus",
            remedy="--yield-stress 160 --hardening-modulus 500, --curve Swift,520,0.004,0.22, or --flow-curve coil.csv",
        )
    hardening: Hardening
    if curve is not None:
        hardening = _curve(curve)
    elif flow_curve is not None:
        hardening = read_flow_curve(flow_curve)
    else:
        assert yield_stress is not None
        with _asked_by("--yield-stress, --hardening-modulus"):
            hardening = Linear(yield_stress, modulus) if modulus else Perfect(yield_stress)
    with _asked_by("--young, --poisson"):
        return J2(E=E, nu=nu, hardening=hardening)


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
