"""The list of controls of a model, which its supports, its loads and its tools add to."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from umform.errors import InvalidValue
from umform.model.boundary import Control

if TYPE_CHECKING:
    from umform.model.assembly import Assembly

#: Columns of every history.
_COLUMNS = ("step", "time", "iterations", "external_work", "elastic_energy", "plastic_work", "contact_energy")
_C = TypeVar("_C", bound=Control)


class Controlled:
    """Something with controls of different names."""

    def __init__(self) -> None:
        self.controls: list[Control] = []
        self._assembled: Assembly | None = None  # made anew when supports, ties, pressures or contacts change

    def of_kind(self, kind: type[_C]) -> list[_C]:
        """Controls of a kind, in the order in which they were made."""
        return [control for control in self.controls if isinstance(control, kind)]

    def forget_assembly(self) -> None:
        """Build pattern and maps again at the next evaluation."""
        self._assembled = None

    def free_name(self, base: str) -> str:
        """A name that no control has: the given one, or with a number."""
        return self._name(base)

    def _add(self, control: _C) -> _C:
        if any(other.name == control.name for other in self.controls) or control.name in _COLUMNS:
            raise InvalidValue("the name of a control is taken", value=control.name, remedy="give it another name")
        self.controls.append(control)
        self._assembled = None
        return control

    def _name(self, base: str) -> str:
        taken = {control.name for control in self.controls}
        return base if base not in taken else next(f"{base}{k}" for k in range(2, 10**6) if f"{base}{k}" not in taken)
