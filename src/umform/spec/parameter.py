"""What a field of a Spec says of itself: type, bounds, unit, default and one sentence."""

from __future__ import annotations

import ast
import inspect
import math
import operator
import re
import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping
from dataclasses import Field, dataclass, field, fields
from functools import cache, reduce
from itertools import pairwise
from numbers import Integral, Real
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt

#: Bounds of the vocabulary: the name of the limit in its class, what holds, and the text.
_BOUNDS: dict[type, tuple[str, Callable[[Any, Any], bool], str]] = {
    Gt: ("gt", operator.gt, "more than"),
    Ge: ("ge", operator.ge, "at least"),
    Lt: ("lt", operator.lt, "less than"),
    Le: ("le", operator.le, "at most"),
}


@dataclass(frozen=True)
class About:
    """What a type says besides its bounds.

    Attributes
    ----------
    unit : str
        Unit.
    cause, remedy : str
        Likely cause of an invalid value, and remedy; by default the unit and the default of the field.
    """

    unit: str = ""
    cause: str = ""
    remedy: str = ""

    def __get_pydantic_json_schema__(self, schema: Any, handler: Callable[[Any], dict[str, Any]]) -> dict[str, Any]:
        """The JSON schema with the unit."""
        return handler(schema) | ({"unit": self.unit} if self.unit else {})


@dataclass(frozen=True)
class Kind:
    """One type that a value may have: a number with bounds, a flag, a word, or an object of any kind."""

    type: type
    choices: tuple[Any, ...] = ()
    bounds: tuple[Any, ...] = ()

    def fits(self, value: Any) -> bool:
        """Whether a value has this type and lies within the bounds."""
        if self.choices:
            return value in self.choices
        if self.type is float:
            typed = not isinstance(value, bool) and isinstance(value, Real) and math.isfinite(value)
        elif self.type is int:
            typed = not isinstance(value, bool) and isinstance(value, Integral)
        else:
            return isinstance(value, self.type)
        return typed and all(holds(value, limit) for _, limit, holds, _ in self.limits())

    def limits(self) -> Iterator[tuple[str, float, Callable[[Any, Any], bool], str]]:
        """Name, limit, comparison and text of each bound."""
        for bound in self.bounds:
            name, holds, text = _BOUNDS[type(bound)]
            yield name, getattr(bound, name), holds, text

    def __str__(self) -> str:
        if self.choices:
            return " or ".join(map(str, self.choices))
        if self.type is bool:
            return "true or false"
        by = {name: f"{limit:.15g}" for name, limit, _, _ in self.limits()}
        noun = {int: "a whole number", float: "a number", str: "a text"}.get(self.type, "an object")
        if {"ge", "le"} <= set(by):
            return f"{noun} from {by['ge']} to {by['le']}"
        if {"gt", "lt"} <= set(by):
            return f"{noun} between {by['gt']} and {by['lt']}"
        if by == {"gt": "0"}:
            return "positive and finite" if self.type is float else f"{noun} above zero"
        texts = [f"{text} {by[name]}" for name, _, _, text in self.limits()]
        return " ".join([noun, *([f"of {' and '.join(texts)}"] if texts else [])])


@dataclass(frozen=True)
class Parameter:
    """A parameter, as its field declares it.

    Attributes
    ----------
    name : str
        Its name.
    default : object
        Its default; `dataclasses.MISSING` without one, or where a factory makes it.
    sentence : str
        What it is: a noun phrase, then, after a semicolon, what holds without it.
    kinds : tuple of Kind
        Types that it may have.
    optional : bool
        Whether it may be None.
    about : About
        Unit and likely mistake.
    rules : tuple
        Further conditions, in the order of the annotation: each has ``fits(value)``.
    """

    name: str
    default: Any
    sentence: str
    kinds: tuple[Kind, ...]
    optional: bool = False
    about: About = field(default_factory=About)
    rules: tuple[Any, ...] = ()

    def fits(self, value: Any) -> bool:
        """Whether a value is valid."""
        if value is None:
            return self.optional
        return any(kind.fits(value) for kind in self.kinds) and all(rule.fits(value) for rule in self.rules)

    @property
    def most(self) -> Any:
        """Upper limit; infinity without one."""
        limits = [limit for kind in self.kinds for name, limit, _, _ in kind.limits() if name in ("lt", "le")]
        return limits[0] if limits else math.inf

    @property
    def noun(self) -> str:
        """The first clause of the sentence, within a sentence."""
        clause = self._clauses[0]
        return clause if clause[:2].isupper() else clause[:1].lower() + clause[1:]

    @property
    def text(self) -> str:
        """The sentence, with the unit behind its first clause."""
        clause, rest = self._clauses
        return f"{clause}{f' in {self.about.unit}' if self.about.unit else ''}{rest}."

    @property
    def _clauses(self) -> tuple[str, str]:
        """The first clause, and the rest with the sign before it."""
        clause = re.split("[;:,]", self.sentence.rstrip("."), maxsplit=1)[0]
        return clause, self.sentence.rstrip(".")[len(clause) :]

    @property
    def must_be(self) -> str:
        """What a valid value is."""
        return " or ".join(map(str, self.kinds))

    @property
    def remedy(self) -> str:
        """How to write it."""
        parts = [f"in {self.about.unit}"] if self.about.unit else []
        if isinstance(self.default, int | float) and not isinstance(self.default, bool):
            parts.append(f"such as {self.default:g}")
        usual = self.about.remedy or ", ".join(parts) or self.must_be
        return f"{usual}; or leave it out" if self.optional else usual


@cache
def parameters(spec: type) -> Mapping[str, Parameter]:
    """The parameters of a Spec by name, in the order of its fields."""
    written = sentences(spec)
    return {one.name: _parameter(spec, one, written.get(one.name, "")) for one in fields(spec)}


def _parameter(spec: type, one: Field[Any], sentence: str) -> Parameter:
    arms = list(_arms(_hint(spec, one)))
    kinds = tuple(_kind(arm, extras) for arm, extras in arms if arm is not type(None))
    extras = [extra for _, more in arms for extra in more]
    abouts = [extra for extra in extras if isinstance(extra, About)]
    about = reduce(_over, abouts, About())
    rules = tuple(extra for extra in extras if hasattr(extra, "fits"))
    return Parameter(one.name, one.default, sentence, kinds, len(kinds) < len(arms), about, rules)


def _over(under: About, over: About) -> About:
    """Two descriptions, the outer one over the inner."""
    return About(over.unit or under.unit, over.cause or under.cause, over.remedy or under.remedy)


def _hint(spec: type, one: Field[Any]) -> Any:
    """The annotation of a field; names that are imported for types only are objects of any kind."""
    if not isinstance(one.type, str):
        return one.type
    for base in spec.__mro__:
        if one.name in vars(base).get("__annotations__", ()):
            return eval(one.type, {}, _Names(vars(sys.modules[base.__module__])))
    raise AssertionError(one.name)


class _Names(dict[str, Any]):
    """Names of a module; others are `object`."""

    def __missing__(self, name: str) -> Any:
        return vars(sys.modules["builtins"]).get(name, object)


def _arms(hint: Any, extras: tuple[Any, ...] = ()) -> Iterator[tuple[Any, tuple[Any, ...]]]:
    """The types of a union, each with the metadata of its annotation, inner ones first."""
    if get_origin(hint) is Annotated:
        inner, *outer = get_args(hint)
        yield from _arms(inner, (*outer, *extras))
    elif get_origin(hint) in (Union, UnionType):
        for arm in get_args(hint):
            yield from _arms(arm, extras)
    else:
        yield hint, extras


def _kind(hint: Any, extras: tuple[Any, ...]) -> Kind:
    if get_origin(hint) is Literal:
        return Kind(str, get_args(hint))
    known = hint if hint in (float, int, bool, str) else object
    return Kind(known, (), tuple(extra for extra in extras if type(extra) in _BOUNDS))


def sentences(spec: type) -> dict[str, str]:
    """The strings below the fields of a class and its bases."""
    found: dict[str, str] = {}
    for base in reversed(spec.__mro__):
        if "__annotations__" not in vars(base):
            continue
        body = ast.parse(textwrap.dedent(inspect.getsource(base))).body[0]
        assert isinstance(body, ast.ClassDef)
        for first, second in pairwise(body.body):
            if isinstance(first, ast.AnnAssign) and isinstance(first.target, ast.Name):
                text = second.value if isinstance(second, ast.Expr) else None
                if isinstance(text, ast.Constant) and isinstance(text.value, str):
                    found[first.target.id] = inspect.cleandoc(text.value).replace("\n", " ")
    return found
