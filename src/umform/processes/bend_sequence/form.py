"""Sequences of bends as data: of a TOML file, or of a form in JSON."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import MISSING
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model

from umform.errors import FileProblem
from umform.problem.errors import ANY_CAUSE, DeckKey, shortened, slip
from umform.problem.messages import worded
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.outside import OutsideBend, OutsidePart
from umform.processes.bend_sequence.spec import TOOLS, Bend, BendSequence, Bodies
from umform.spec import parameters
from umform.spec.types import Length

_B = TypeVar("_B", Bend, OutsideBend)


class _Form(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def _keys(kind: type) -> dict[str, Any]:
    """Keys of a bend: its fields, but for the tools, whose sizes are keys themselves."""
    own = {
        name: (one.hint, ... if one.default is MISSING else one.default)
        for name, one in parameters(kind).items()
        if name != "tools"
    }
    return own | {name: (parameters(AirBending)[name].hint | None, None) for name in TOOLS}


def _made(kind: type[_B], form: BaseModel) -> _B:
    given: dict[str, Any] = dict(form)
    tools = {name: given.pop(name) for name in TOOLS}
    return kind(**given, tools={name: size for name, size in tools.items() if size is not None})


class BendForm(create_model("_Keys", __base__=_Form, **_keys(Bend))):  # type: ignore[misc]
    """One bend: `Bend`, with the sizes of its tools as further keys."""

    def bend(self) -> Bend:
        """The bend."""
        return _made(Bend, self)


class SequenceForm(_Form):
    """Length of the flat strip, its bends in order, bodies of the tools."""

    length: Length
    bends: Annotated[list[BendForm], Field(min_length=1, max_length=50)]
    bodies: Bodies = Bodies()

    def sequence(self, sheet: AirBending) -> BendSequence:
        """The sequence with thickness, material, mesh and the default tools.

        Raises
        ------
        InvalidValue
            ``where`` is the name of the parameter, or the number of the bend.
        """
        return BendSequence(self.length, tuple(bend.bend() for bend in self.bends), sheet, self.bodies)


class OutsideBendForm(create_model("_OutsideKeys", __base__=_Form, **_keys(OutsideBend))):  # type: ignore[misc]
    """One bend between two flanges: `OutsideBend`, with the sizes of its tools as further keys."""

    def bend(self) -> OutsideBend:
        """The bend."""
        return _made(OutsideBend, self)


class OutsideForm(_Form):
    """Outside lengths of the flanges from left to right, the bends in order, and what gives their deductions."""

    flanges: Annotated[list[Length], Field(min_length=2, max_length=51)]
    bends: Annotated[list[OutsideBendForm], Field(min_length=1, max_length=50)]
    acute: Literal["apex", "tangent"] = "apex"
    k_factor: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    table: str | None = None
    bodies: Bodies = Bodies()

    def part(self) -> OutsidePart:
        """The part.

        Raises
        ------
        InvalidValue
            If flanges and bends do not belong together.
        """
        return OutsidePart(tuple(self.flanges), tuple(bend.bend() for bend in self.bends), self.acute)


def read_sequence(path: Path) -> SequenceForm | OutsideForm:
    """Read a TOML file.

    Raises
    ------
    FileProblem, DeckKey
        If it cannot be read, or is no valid sequence.
    """
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        no_text = "another kind of file, or text that is not UTF-8" if isinstance(error, UnicodeDecodeError) else ""
        raise FileProblem(
            "the sequence of bends cannot be read",
            where=str(path),
            cause=no_text or getattr(error, "strerror", None) or str(error),
            remedy="a TOML file with length or flanges, and a table [[bends]] for each bend, see "
            "docs/bending-operations.md",
        ) from error
    if "steps" in data:
        raise FileProblem(
            "this is a deck and no sequence of bends",
            where=str(path),
            cause="it has a table [[steps]]",
            remedy=f"umform run {path}",
        )
    return sequence_form(data, str(path))


def sequence_form(data: Any, where: str = "sequence") -> SequenceForm | OutsideForm:
    """The form from data: with the positions of the bend lines, or with the key flanges by outside dimensions.

    Raises
    ------
    DeckKey
        With the invalid key.
    """
    form = OutsideForm if isinstance(data, Mapping) and "flanges" in data else SequenceForm
    try:
        return form.model_validate(data)
    except ValidationError as error:
        raise _invalid(error, where, form) from error


def _invalid(error: ValidationError, where: str, form: type[SequenceForm] | type[OutsideForm]) -> DeckKey:
    """The error of an unknown key, else the first one; bends are counted from 1."""
    found = error.errors(include_url=False)
    first = next((one for one in found if one["type"] == "extra_forbidden"), found[0])
    *table, last = first["loc"] or ("",)
    way = (f"bend {part + 1}" if isinstance(part, int) else part for part in table if part != "bends")
    place = ", ".join([where, *way])
    outside = form is OutsideForm
    bend = OutsideBendForm if outside else BendForm
    known = list(bend.model_fields if "bends" in table else form.model_fields)
    if first["type"] == "extra_forbidden" and "bodies" not in table:
        remedy = f"known keys: {', '.join(known)}"
        return DeckKey("this key is unknown here", where=place, value=last, cause=slip(last, known), remedy=remedy)
    if first["type"] == "missing":
        what, value, cause = f"the key {last} is missing", None, "it was left out"
    else:
        what, value, cause = f"{last}: {worded(first['msg'])}", shortened(first["input"]), ANY_CAUSE
    remedy = (
        "flanges, and an angle for each of the bends"
        if outside
        else "length, and position with angle or stroke for each of the bends; or flanges, for outside dimensions"
    )
    return DeckKey(what, where=place, value=value, cause=cause, remedy=remedy)
