"""Options that are read off Specs: name, type, default, help and panel of each field."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import MISSING
from types import MappingProxyType
from typing import Annotated, Any, get_type_hints

from umform.cli.options import option
from umform.spec import Parameter, parameters

#: Values by the names of fields, as a command gets them.
Given = dict[str, Any]
#: Letters of what is typed daily; `options.py` and the commands have those of options that are no fields.
_LETTERS = {"thickness": "-t", "opening": "-V", "angle": "-a", "stroke": "-s"}


def given_by(
    *specs: type,
    omit: Collection[str] = (),
    called: Mapping[str, str] = MappingProxyType({}),
    otherwise: Mapping[str, str] = MappingProxyType({}),
    **defaults: Any,
) -> Callable[[Callable[..., Any]], Any]:
    """Give a command the options of all fields of Specs; its parameter ``given`` gets their values by name.

    Parameters
    ----------
    *specs : type
        Dataclasses with ``groups``: the panel of the options from each named field on.
    omit : collection of str
        Fields that the command takes in another way.
    called : mapping of str to str
        Options of fields that have another name than the field.
    otherwise : mapping of str to str
        Defaults in words, of options without a default of their own.
    **defaults : object
        Defaults of this command where they differ; None for an option that need not be given.
    """
    options = [one for spec in specs for one in _options(spec, omit, called, otherwise, defaults)]
    return in_place_of("given", options, dict)


def in_place_of(
    name: str, options: Sequence[inspect.Parameter], made_of: Callable[[dict[str, Any]], Any]
) -> Callable[[Callable[..., Any]], Any]:
    """Give a command some options in place of one of its parameters, which gets what is made of their values."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        own = inspect.signature(command)
        names = [one.name for one in options]
        kind = own.parameters[name].kind

        def run(**values: Any) -> Any:
            return command(**{name: made_of({one: values.pop(one) for one in names})}, **values)

        hints = get_type_hints(command, include_extras=True)
        before = [one.replace(annotation=hints[one.name]) for one in own.parameters.values() if one.name != name]
        at = list(own.parameters).index(name)
        run.__name__, run.__doc__, run.__module__ = command.__name__, command.__doc__, command.__module__
        shown = [*before[:at], *(one.replace(kind=kind) for one in options), *before[at:]]
        run.__signature__ = inspect.Signature(shown, return_annotation=None)  # type: ignore[attr-defined]
        run.__annotations__ = {one.name: one.annotation for one in shown}
        return run

    return decorate


def _options(
    spec: type, omit: Collection[str], called: Mapping[str, str], otherwise: Mapping[str, str], defaults: dict[str, Any]
) -> list[inspect.Parameter]:
    found, panel = [], ""
    groups: dict[str, str] = spec.groups  # type: ignore[attr-defined]
    for name, parameter in parameters(spec).items():
        panel = groups.get(name, panel)
        if name not in omit:
            default = defaults.get(name, parameter.default)
            long = called.get(name) or (f"--{name.replace('_', '-')}" if name in _LETTERS else "")
            info = _info(parameter, panel, [*filter(None, (long, _LETTERS.get(name)))])
            info.help = f"{parameter.text.rstrip('.')}; default: {otherwise[name]}." if name in otherwise else info.help
            hint = Annotated[_hint(parameter, default), info]  # type: ignore[valid-type]
            no_default = inspect.Parameter.empty if default is MISSING else default
            kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
            found.append(inspect.Parameter(name, kind, default=no_default, annotation=hint))
    return found


def _hint(parameter: Parameter, default: Any) -> Any:
    types = {kind.type for kind in parameter.kinds}
    plain = next(iter(types)) if len(types) == 1 else str
    return plain | None if parameter.optional or default is None else plain


def _info(parameter: Parameter, panel: str, names: Sequence[str]) -> Any:
    info = option(parameter.text, panel, *names)
    if {int, str} <= {kind.type for kind in parameter.kinds}:
        info.parser, info.metavar = _number_or_word, "<int|word>"
    return info


def _number_or_word(text: str) -> int | str:
    return int(text) if text.isdecimal() else text
