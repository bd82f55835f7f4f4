"""What a field of a Spec says of itself: type, bounds, unit, default and one sentence."""

from __future__ import annotations

import ast
import inspect
import math
import operator
import re
import sys
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields
from functools import cache, reduce
from itertools import pairwise
from numbers import Integral, Real
from os import PathLike
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt

from umform.errors import InvalidValue

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
    error : type, optional
        Class of the error; by default `InvalidValue`, or `NotFinite` for NaN and infinity.
    """

    unit: str = ""
    cause: str = ""
    remedy: str = ""
    error: type[InvalidValue] | None = None

    def __get_pydantic_json_schema__(self, schema: Any, handler: Callable[[Any], dict[str, Any]]) -> dict[str, Any]:
        """The JSON schema with the unit."""
        return handler(schema) | ({"unit": self.unit} if self.unit else {})


@dataclass(frozen=True)
class Kind:
    """One type that a value may have: a number with bounds, a flag, a word, an array, or an object of any kind.

    Further conditions have ``fits(value)``, in the order of the annotation. ``entries`` are the types that an entry of
    an array may have.
    """

    type: type
    choices: tuple[Any, ...] = ()
    bounds: tuple[Any, ...] = ()
    rules: tuple[Any, ...] = ()
    entries: tuple[Kind, ...] = ()

    def fits(self, value: Any) -> bool:
        """Whether a value has this type and lies within the bounds."""
        if self.choices:
            return isinstance(value, Hashable) and value in self.choices
        if not self.is_of(value) or (self.type is float and not math.isfinite(value)):
            return False
        return all(holds(value, limit) for _, limit, holds, _ in self.limits())

    def is_of(self, value: Any) -> bool:
        """Whether a value has this type, and each of its entries one of theirs."""
        if self.entries:
            listed = isinstance(value, Collection) and are_several(value)
            return listed and all(any(kind.is_of(entry) for kind in self.entries) for entry in value)
        if self.type in (float, int):
            return not isinstance(value, bool) and isinstance(value, Real if self.type is float else Integral)
        return isinstance(value, self.type)

    def limits(self) -> Iterator[tuple[str, float, Callable[[Any, Any], bool], str]]:
        """Name, limit, comparison and text of each bound."""
        for bound in self.bounds:
            name, holds, text = _BOUNDS[type(bound)]
            yield name, getattr(bound, name), holds, text

    def __str__(self) -> str:
        if self.choices:
            *some, last = map(str, self.choices)
            return f"{', '.join(some)} or {last}" if some else last
        if self.type is bool:
            return "true or false"
        by = {name: f"{limit:.15g}" for name, limit, _, _ in self.limits()}
        nouns: dict[Any, str] = {int: "a whole number", float: "a number", str: "a text", object: "an object"}
        nouns |= {Collection: "an array", Mapping: "a dictionary", Callable: "a function", PathLike: "a path"}
        noun = nouns.get(self.type, f"an object {self.type.__name__}")
        if {"ge", "le"} <= set(by):
            return f"{noun} from {by['ge']} to {by['le']}"
        if {"gt", "lt"} <= set(by):
            return f"{noun} between {by['gt']} and {by['lt']}"
        if by == {"gt": "0"}:
            return "positive and finite" if self.type is float else f"{noun} above zero"
        texts = [f"{text} {by[name]}" for name, _, _, text in self.limits()]
        if self.entries:
            noun = f"{noun} whose entries are each {' or '.join(dict.fromkeys(map(str, self.entries)))}"
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
    spec : type
        The Spec.
    kinds : tuple of Kind
        Types that it may have.
    optional : bool
        Whether it may be None.
    about : About
        Unit and likely mistake.
    hint : object
        The annotation.
    factory : callable or None
        Makes the default.
    """

    name: str
    default: Any
    spec: type
    kinds: tuple[Kind, ...]
    optional: bool = False
    about: About = field(default_factory=About)
    hint: Any = None
    factory: Callable[[], Any] | None = None

    def fits(self, value: Any) -> bool:
        """Whether a value is valid."""
        if value is None:
            return self.absent
        kind = self.kind_of(value)
        return kind is not None and all(rule.fits(value) for rule in kind.rules)

    def kind_of(self, value: Any) -> Kind | None:
        """The first type that a value has within its bounds."""
        return None if value is None else next((kind for kind in self.kinds if kind.fits(value)), None)

    @property
    def absent(self) -> bool:
        """Whether a value may be missing: it is optional, or others determine it."""
        return self.optional or self.default is None

    @property
    def most(self) -> Any:
        """Upper limit; infinity without one."""
        limits = [limit for kind in self.kinds for name, limit, _, _ in kind.limits() if name in ("lt", "le")]
        return limits[0] if limits else math.inf

    @property
    def sentence(self) -> str:
        """What it is: a noun phrase, then, after a semicolon, what holds without it."""
        words = [word for kind in self.kinds for word in kind.choices]
        return sentences(self.spec).get(self.name) or (f"The word {words[0]}." if len(words) == 1 else "")

    @property
    def noun(self) -> str:
        """The first clause of the sentence, within a sentence."""
        clause = self._clauses[0]
        return clause if clause[:2].isupper() else clause[:1].lower() + clause[1:]

    @property
    def subject(self) -> str:
        """The same with its article, which names of persons, and clauses that begin with one, do not have.

        Without a sentence, the name.
        """
        if not self.sentence:
            return self.name
        if re.match(r"(An?|The|How) ", self.sentence):
            return self.sentence[:1].lower() + self._clauses[0][1:]
        return self._clauses[0] if re.match(r"[A-Z]\w*'s ", self.sentence) else f"the {self.noun}"

    @property
    def text(self) -> str:
        """The sentence, with the unit behind its first clause."""
        clause, rest = self._clauses
        return f"{clause}{f' in {self.about.unit}' if self.about.unit else ''}{rest}."

    @property
    def _clauses(self) -> tuple[str, str]:
        """The first clause, and the rest with the sign before it."""
        clause = re.split(r"[;:,]|\.\s", self.sentence.rstrip("."), maxsplit=1)[0]
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


@dataclass(frozen=True)
class FieldOf:
    """Annotation of a field that is one of another Spec, or a parameter of a function.

    Attributes
    ----------
    spec : type or function
        The other Spec, or the function.
    name : str
        Name there.
    hint : object, optional
        Another type than there.
    """

    spec: Any
    name: str
    hint: Any = None


@cache
def declared(spec: Any) -> Sequence[Field[Any]]:
    """Fields of a Spec; of a function, its named parameters in their place."""
    if isinstance(spec, type):
        return [one for one in fields(spec) if one.init]
    found: list[Any] = []
    for one in inspect.signature(spec).parameters.values():
        if one.name != "self" and one.kind not in (one.VAR_POSITIONAL, one.VAR_KEYWORD):
            found.append(field(default=MISSING if one.default is one.empty else one.default))
            found[-1].name, found[-1].type = one.name, one.annotation
    return found


@cache
def parameters(spec: Any) -> Mapping[str, Parameter]:
    """The parameters of a Spec by name, in the order of its fields; or those of a function."""
    return {one.name: _parameter(spec, one) for one in declared(spec)}


def _parameter(spec: Any, one: Field[Any]) -> Parameter:
    hint = hint_of(spec, one)
    arms = list(_arms(hint))
    kinds = tuple(_kind(arm, extras) for arm, extras in arms if arm is not type(None))
    extras = [extra for _, more in arms for extra in more]
    abouts = [extra for extra in extras if isinstance(extra, About)]
    about = reduce(_over, abouts, About())
    optional = len(kinds) < len(arms)
    factory = None if one.default_factory is MISSING else one.default_factory
    return Parameter(one.name, one.default, spec, kinds, optional, about, hint, factory)


def _over(under: About, over: About) -> About:
    """Two descriptions, the outer one over the inner."""
    pairs = ((getattr(over, name), getattr(under, name)) for name in ("unit", "cause", "remedy", "error"))
    return About(*(first or second for first, second in pairs))


def hint_of(spec: Any, one: Field[Any]) -> Any:
    """The annotation of a field; classes that are imported for types only are known by their names."""
    kind: Any = one.type
    if isinstance(kind, FieldOf):
        kind = kind.hint or parameters(kind.spec)[kind.name].hint
    if not isinstance(kind, str):
        return kind
    if not isinstance(spec, type):
        return eval(kind, {}, _Names(spec.__globals__))
    for base in spec.__mro__:
        if one.name in vars(base).get("__annotations__", ()):
            return eval(kind, {}, _Names(vars(sys.modules[base.__module__])))
    raise AssertionError(one.name)


class _Names(dict[str, Any]):
    """Names of a module; others are `_Named`."""

    def __missing__(self, name: str) -> Any:
        return vars(sys.modules["builtins"]).get(name) or _Named(name, (), {})


class _Named(type):
    """In place of a class that is not imported: its objects are those of all classes of this name."""

    def __instancecheck__(cls, value: object) -> bool:
        return any(base.__name__ == cls.__name__ for base in type(value).__mro__)


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
    rules = tuple(extra for extra in extras if hasattr(extra, "fits"))
    if get_origin(hint) is Literal:
        return Kind(str, get_args(hint), (), rules)
    known: Any = object
    if isinstance(hint, type) and hint is not Any and not getattr(hint, "_is_protocol", False):
        known = hint
    entries: tuple[Kind, ...] = ()
    if get_origin(hint) in (tuple, list, Sequence, Collection):
        known = Collection  # lists, tuples, arrays
        entries = tuple(_kind(*arm) for part in get_args(hint) if part is not ... for arm in _arms(part))
    elif get_origin(hint) in (dict, Mapping):
        known = Mapping
    elif get_origin(hint) is PathLike or known is Path:
        known = PathLike
    elif get_origin(hint) is Callable or (getattr(hint, "_is_protocol", False) and "__call__" in vars(hint)):
        known = Callable
    elif isinstance(known, _Named) and rules:
        known = object  # the rules say better what it must be
    return Kind(known, (), tuple(extra for extra in extras if type(extra) in _BOUNDS), rules, entries)


def are_several(values: Any) -> bool:
    """Whether values are those of a list, a tuple, an array; a text is one value."""
    return isinstance(values, Iterable) and not isinstance(values, str) and getattr(values, "shape", 1) != ()


@cache
def _classes(module: str) -> dict[str, list[ast.stmt]]:
    """Statements of all classes of a module by their names; none of a module that no file has."""
    try:
        tree = ast.parse(inspect.getsource(sys.modules[module]))
    except (OSError, TypeError, KeyError):
        return {}
    return dict(_within(tree, ""))


def _within(node: ast.AST, name: str) -> Iterator[tuple[str, list[ast.stmt]]]:
    for one in ast.iter_child_nodes(node):
        if isinstance(one, ast.ClassDef):
            yield f"{name}{one.name}", one.body
            yield from _within(one, f"{name}{one.name}.")
        elif isinstance(one, ast.FunctionDef):
            yield from _within(one, f"{name}{one.name}.<locals>.")


@cache
def sentences(spec: Any) -> dict[str, str]:
    """The strings below the fields of a class and its bases; of a function, the texts of its parameters."""
    found: dict[str, str] = {}
    if not isinstance(spec, type):
        section = inspect.cleandoc(spec.__doc__ or "").partition("\nParameters\n----------\n")[2].partition("\n\n")[0]
        for names, text in re.findall(r"^(\w.*?)(?: : .*)?\n((?:    .*\n?)+)", section, re.MULTILINE):
            other = re.match(r"\s*As for :func:`(\w+)`", text)
            known = sentences(spec.__globals__[other[1]]) if other else {}
            found |= {name: known.get(name, " ".join(text.split())) for name in names.split(", ")}
        return found
    for base in reversed(spec.__mro__):
        if "__annotations__" not in vars(base):
            continue
        for name, hint in base.__annotations__.items():
            if isinstance(hint, FieldOf):
                found[name] = sentences(hint.spec).get(hint.name, "").replace("``", "")
        for first, second in pairwise(_classes(base.__module__).get(base.__qualname__, ())):
            if isinstance(first, ast.AnnAssign) and isinstance(first.target, ast.Name):
                below = second.value if isinstance(second, ast.Expr) else None
                if isinstance(below, ast.Constant) and isinstance(below.value, str):
                    found[first.target.id] = inspect.cleandoc(below.value).replace("\n", " ")
    return found
