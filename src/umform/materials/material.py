"""Interface between a model and its material."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from umform import _core


@runtime_checkable
class Material(Protocol):
    """Interface of a material: the law of the kernels and the default number of thickness points."""

    @property
    def thickness_points(self) -> int | None:
        """Default number of Gauss points through the thickness; None: 2, or those of the element with a history."""

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
