"""Further sheets of ``umform bend`` from options: a metal, a thickness, friction with the sheet below."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

from umform.cli.metal import by_name
from umform.cli.options import SHEET, option
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.processes.air_bending.stack import StackedSheet

OnTop = Annotated[
    list[str] | None,
    option(
        "A further sheet on those before, as METAL,THICKNESS or METAL,THICKNESS,FRICTION: a metal as in --material, "
        "and its coefficient of friction with the sheet below, or the word bonded where it sticks to it; repeatable.",
        SHEET,
    ),
]


@by_name("--on-top", ", or a file with [material]")
def stacked(texts: Sequence[str]) -> list[StackedSheet]:
    """The sheets of the options, from the lowest upwards."""
    from umform.problem.metal_file import metal_of
    from umform.processes.air_bending.stack import StackedSheet

    sheets = []
    for text in texts:
        name, *rest = text.split(",")
        numbers: list[float] = []
        if bonded := len(rest) == 2 and rest[1].strip() == "bonded":
            rest = rest[:1]
        with suppress(ValueError):
            numbers = [float(part) for part in rest]
        if len(numbers) not in (1, 2):
            raise InvalidValue(
                "a further sheet has a metal, a thickness and perhaps a coefficient of friction",
                where="--on-top",
                value=text,
                cause="a number is missing, or a decimal comma",
                remedy="--on-top DC04,0.8 or --on-top foil.toml,0.1,0.2 or --on-top foil.toml,0.1,bonded",
            )
        try:
            sheet = StackedSheet(numbers[0], metal_of(name.strip(), numbers[0]).law, bonded=bonded)
            sheets.append(replace(sheet, friction=numbers[1]) if numbers[1:] else sheet)
        except InvalidValue as error:
            size = error.where.rpartition(", ")[2]  # of the sheet, or of the metal at this thickness
            if size in ("thickness", "friction"):
                error.where = f"--on-top, {size}"
            raise
    return sheets
