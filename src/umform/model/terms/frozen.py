"""Attributes that are fixed at construction: a later change would have no effect and is refused."""

from __future__ import annotations

from typing import Any, ClassVar, NoReturn

from umform.errors import InvalidValue


class Frozen:
    """Something with attributes that are set once.

    Attributes
    ----------
    fixed : tuple of str
        Names of these attributes.
    """

    fixed: ClassVar[tuple[str, ...]] = ()

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self.fixed and name in self.__dict__:
            self.refuse(name, value)
        super().__setattr__(name, value)

    def refuse(self, name: str, value: object) -> NoReturn:
        """Raise an error on setting an attribute.

        Raises
        ------
        InvalidValue
            Always.
        """
        kind = type(self).__name__.lower()
        raise InvalidValue(
            f"{name} is fixed when a {kind} is made",
            where=f"{kind} {self.__dict__.get('name', '')}".strip(),
            value=value,
            cause="the kernels have what was given first",
            remedy="make a new model with it",
        )
