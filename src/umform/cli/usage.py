"""Errors of typing: unknown options, missing arguments, values that are no numbers."""

from __future__ import annotations

import re
from typing import Any

from umform.errors import InvalidValue

_NO_NUMBER = re.compile(r"'(?P<value>[^']*)' is not a valid (?P<kind>float|integer|int)\b")
_COMMA = re.compile(r"[-+]?\d*,\d+")
_UNIT = re.compile(r"(?P<number>[-+]?\d*\.?\d+)\s*(?P<unit>[^\W\d]\w*|[\"″])")
#: Other units of length in mm.
_MILLIMETRES = {"in": 25.4, "inch": 25.4, "inches": 25.4, '"': 25.4, "″": 25.4, "cm": 10.0}
#: Likely causes by the beginnings of the texts of click.
_CAUSES = {
    "Missing": "it was left out",
    "No such command": "a typing mistake",
    "Got unexpected extra argument": "a name with blanks without quotes, or an option without its dashes",
    "Invalid value": "a sign, or a typing mistake",
    "Option": "nothing stands behind it, or a value behind a switch",
}
#: Commands of a group that are too many for a message.
_MANY = 10
#: What there is beside the commands of a group.
_BESIDE = {"draw": "other parts are decks, such as `umform new square-cup`; `umform new` lists them"}


def is_usage_error(error: BaseException) -> bool:
    """Whether an error is one of typing; typer has classes of its own or those of click."""
    kinds = [kind.__name__ for kind in type(error).__mro__]
    return "UsageError" in kinds and "NoArgsIsHelpError" not in kinds  # the latter only shows the help


def usage_problem(error: Any) -> InvalidValue:
    """The error with place, value, cause and remedy."""
    command = getattr(error.ctx, "command_path", "umform")
    more = f"`{command} --help` lists all options"
    if type(error).__name__ == "NoSuchOption":
        near = " or ".join(error.possibilities or ())
        return InvalidValue(
            "there is no such option",
            where=command,
            value=error.option_name,
            cause="a typing mistake" if near else "a typing mistake, or an option of another command",
            remedy=f"perhaps {near} is meant; {more}" if near else more,
        )
    text, place = error.format_message(), _place(error, command)
    commands = list(getattr(getattr(error.ctx, "command", None), "commands", {}))
    if text.startswith("No such command") and len(commands) < _MANY:
        more = f"{command} {', '.join(commands)}; {_BESIDE.get(command.split()[-1], more)}"
    value, kind = _refused(error, text)
    if kind in ("float", "integer", "int"):
        return _no_number(value, place, whole=kind != "float")
    cause = next((cause for begin, cause in _CAUSES.items() if text.startswith(begin)), "")
    return InvalidValue(text[:1].lower() + text[1:].rstrip("."), where=place, cause=cause, remedy=more)


def _refused(error: BaseException, text: str) -> tuple[str, str]:
    """Value and wanted kind of a number that cannot be read: from the text of click, or the details of pydantic."""
    found = _NO_NUMBER.search(text)
    if found:
        return found["value"], found["kind"]
    details: list[dict[str, object]] = getattr(error.__cause__, "errors", list)()
    first = details[0] if details else {}
    return str(first.get("input", "")), str(first.get("type", "")).partition("_")[0]


def _no_number(value: str, place: str, *, whole: bool) -> InvalidValue:
    """Error for a value that is no number."""
    cause, remedy = "a word in place of a number", "digits, with a decimal point and without a unit"
    unit = _UNIT.fullmatch(value)
    if whole:
        cause, remedy = "a fraction or a word in place of a whole number", "digits only, such as 2"
    elif _COMMA.fullmatch(value):
        cause, remedy = "a decimal comma", f"write {value.replace(',', '.')}"
    elif unit and unit["unit"] in _MILLIMETRES:
        cause = "a length in another unit: lengths are in mm"
        remedy = f"write {_MILLIMETRES[unit['unit']] * float(unit['number']):.6g}"
    elif unit:
        cause, remedy = "a unit behind the number", f"write {unit['number']}; the help names the unit"
    what = "a whole number is needed here" if whole else "a number is needed here"
    return InvalidValue(what, where=place, value=value, cause=cause, remedy=remedy)


def _place(error: Any, command: str) -> str:
    """The option, or the command of an argument."""
    parameter = getattr(error, "param", None)
    names = getattr(parameter, "opts", None) or [getattr(error, "option_name", command)]
    return str(names[0]) if str(names[0]).startswith("-") else command
