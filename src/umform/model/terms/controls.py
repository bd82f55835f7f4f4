"""The controls of a model, from its supports, loads and tools, and the register of column names."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain, count
from typing import Any, TypeVar

from umform.errors import InvalidValue
from umform.model.terms.control import Control
from umform.model.terms.present_state import Now
from umform.model.terms.state import State
from umform.model.terms.term import Term

#: Columns of every history.
COLUMNS = (
    "step",
    "time",
    "iterations",
    "external_work",
    "elastic_energy",
    "plastic_work",
    "contact_energy",
    "friction_work",
)
_C = TypeVar("_C", bound=Control)
_T = TypeVar("_T")


def columns_of(thing: Any) -> list[str]:
    """Columns of the history that a control or a term writes."""
    if isinstance(thing, Term) and not isinstance(thing, Control):
        return list(thing.column_names())
    return [thing.name, f"{thing.name}_force"]


class Controls(list[Control]):
    """The controls of a model in the order of their creation, and the register of all history columns.

    Parameters
    ----------
    now : Now
        The present state of the model.

    Attributes
    ----------
    beside : list of sequences
        Other objects with columns: tools, contacts, further terms.
    """

    def __init__(self, now: Now) -> None:
        super().__init__()
        self.beside: list[Sequence[Any]] = []
        self._now = now

    def of_kind(self, kind: type[_T]) -> list[_T]:
        """Controls of a class, in the order of their creation."""
        return [control for control in self if isinstance(control, kind)]

    def named(self, name: str) -> Control:
        """The control of a name.

        Raises
        ------
        KeyError
            If there is none.
        """
        for control in self:
            if control.name == name:
                return control
        raise KeyError(name)

    def values_at(self, state: State) -> dict[Control, float]:
        """Values of the controls at a state.

        Raises
        ------
        InvalidValue
            If the state is that of a model with other controls.
        """
        try:
            return {control: state.controls[control.name] for control in self}
        except KeyError as missing:
            raise InvalidValue(
                "a state has no value for a control of the model",
                where="state",
                value=missing.args[0],
                cause="the state of a model with other controls, or one from before the control was made",
                remedy="a state of a model with the same supports, loads and tools",
            ) from None

    def _columns(self) -> dict[str, str]:
        """Each column of the history, and its owner."""
        taken = dict.fromkeys(COLUMNS, "the history itself")
        for thing in chain(self, *self.beside):
            taken |= {column: f"{type(thing).__name__} {thing.name!r}" for column in columns_of(thing)}
        return taken

    def refuse_taken(self, columns: Iterable[str], name: str) -> None:
        """Reject a name whose columns another object writes.

        Raises
        ------
        InvalidValue
            If a column exists already.
        """
        taken = self._columns()
        for column in columns:
            if column in taken:
                raise InvalidValue(
                    "the name is taken: two columns of the history would collide",
                    where=f"name {name!r}",
                    value=f"column {column!r} of {taken[column]}",
                    cause="two things of a model have the same name, or one is named like a column of another",
                    remedy="give it another name",
                )

    def add(self, control: _C) -> _C:
        """Add a control; a taken name is refused."""
        self.refuse_taken(columns_of(control), control.name)
        self.append(control)
        self._now.restructured()
        return control

    def free_name(self, base: str) -> str:
        """An unused name for a control whose columns are also unused."""
        taken = self._columns()
        free = chain([base], (f"{base}{k}" for k in count(2)))
        return next(name for name in free if name not in taken and f"{name}_force" not in taken)
