"""Common base of all parts of a deck: strict types, no unknown keys, and numbers, vectors and directions."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import MISSING, FrozenInstanceError, dataclass, field, fields
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal, Self, dataclass_transform

from umform.errors import InvalidValue
from umform.problem.notes import Discriminator, Field, Tag
from umform.problem.reading import Unfit, read
from umform.spec import FieldOf, declared, parameters


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(field,))
class Part:
    """A table of a deck. Numbers are finite, words are not converted to numbers, and unknown keys are errors.

    A frozen dataclass whose methods are written here once: to generate them for each class takes long.
    """

    #: Keys that are fields of a dataclass, and the fields.
    spec_keys: ClassVar[Mapping[str, FieldOf]] = {}

    def __init_subclass__(
        cls, of: Any = None, leave: Collection[str] = (), called: Mapping[str, str] = MappingProxyType({})
    ) -> None:
        """Declare a table.

        Parameters
        ----------
        of : type or function, optional
            A dataclass whose fields are further keys of the table, or a function whose parameters are; `of_spec`
            returns their values. A key that the class itself annotates has that type; a default and a sentence that it
            has not are those of the field.
        leave : collection of str
            Its fields that are no keys, or keys of which nothing is the same.
        called : mapping of str to str
            Keys that have other names than their fields.
        """
        super().__init_subclass__()
        chosen = {called.get(one.name, one.name): one for one in declared(of) if one.name not in leave} if of else {}
        here = cls.__annotations__
        cls.spec_keys = {key: FieldOf(of, one.name, here.get(key)) for key, one in chosen.items()} or cls.spec_keys
        for key, one in chosen.items():
            here[key] = cls.spec_keys[key]
            if key in vars(cls):
                continue
            if one.default is not MISSING:
                setattr(cls, key, one.default)
            elif one.default_factory is not MISSING:
                setattr(cls, key, field(default_factory=one.default_factory))
        dataclass(init=False, repr=False, eq=False, match_args=False)(cls)

    def __init__(self, **keys: Any) -> None:
        """A table with some keys; its values are checked as in a deck."""
        kind: type = type(self)
        known = parameters(kind) if keys else {}
        for key, value in keys.items():
            try:
                keys[key] = read(known[key].hint, value, {})
            except (KeyError, Unfit):
                what = f"{key} must be {known[key].must_be}" if key in known else "there is no such key"
                where = f"{kind.__name__}.{key}"
                raise InvalidValue(what, where=where, value=value, remedy="docs/decks.md has all keys") from None
        self._take(keys)

    @classmethod
    def of_values(cls, **keys: Any) -> Self:
        """A table with values that are known to be valid."""
        made = object.__new__(cls)
        made._take(keys)
        return made

    def _take(self, keys: Mapping[str, Any]) -> None:
        values = vars(self)
        for one in fields(self):  # type: ignore[arg-type]
            if one.name in keys:
                values[one.name] = keys[one.name]
            elif one.default_factory is not MISSING:
                values[one.name] = one.default_factory()
            elif one.default is not MISSING:
                values[one.name] = one.default
            else:
                raise InvalidValue(
                    f"the key {one.name} is missing",
                    where=type(self).__name__,
                    cause="it has no default",
                    remedy=f"{type(self).__name__}({one.name}=..., ...)",
                )
        self.__post_init__()

    def __post_init__(self) -> None:
        """Refuse values that do not belong together.

        Raises
        ------
        InvalidValue
        """

    def __setattr__(self, name: str, value: Any) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and vars(other) == vars(self)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{key}={value!r}' for key, value in vars(self).items())})"

    def of_spec(self) -> dict[str, Any]:
        """Values of the fields of the dataclass."""
        return {one.name: getattr(self, key) for key, one in self.spec_keys.items()}


Positive = Annotated[float, Field(gt=0.0)]
NotNegative = Annotated[float, Field(ge=0.0)]
Count = Annotated[int, Field(ge=1)]
#: Names become columns of tables and labels of figures.
Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", max_length=60)]
Axis = Literal["x", "y", "z"]

# An array of TOML becomes a tuple.
Pair = tuple[float, float]
Vector = tuple[float, float, float]


def word_or_array(value: Any) -> str | None:
    """Discriminator between two notations of a value, so that only the errors of one are reported."""
    return "word" if isinstance(value, str) else "array" if isinstance(value, list | tuple) else None


def number_or_array(value: Any) -> str | None:
    """Discriminator between two notations of a value."""
    return "array" if isinstance(value, list | tuple) else "number"


def number_or_table(value: Any) -> str | None:
    """Discriminator between two notations of a value."""
    return "table" if isinstance(value, dict) else "number"


def tagged_by(key: str, other: str) -> Callable[[Any], str | None]:
    """Discriminator between kinds of a table: the word of a key, or the name of another key that implies it."""

    def kind(value: Any) -> str | None:
        if isinstance(value, dict):
            word = other if other in value else value.get(key)
            return word if isinstance(word, str) else None
        return other if hasattr(value, other) else getattr(value, key, None)

    return kind


#: "x", "-z", ..., or three numbers.
Way = Annotated[
    Annotated[Literal["x", "y", "z", "-x", "-y", "-z"], Tag("word")] | Annotated[Vector, Tag("array")],
    Discriminator(
        word_or_array,
        custom_error_type="direction",
        custom_error_message="Input should be x, y, z, -x, -y, -z or three numbers",
    ),
]

__all__ = [
    "Axis",
    "Count",
    "Name",
    "NotNegative",
    "Pair",
    "Part",
    "Positive",
    "Vector",
    "Way",
    "number_or_array",
    "number_or_table",
    "tagged_by",
    "word_or_array",
]
