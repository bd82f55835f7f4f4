"""Check of the measures of a deck before its run."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from umform.model import Model
from umform.problem.unloading import loading_steps

if TYPE_CHECKING:
    from umform.problem.contents import Contents


def check_measures(contents: Contents, model: Model, at: Callable[..., AbstractContextManager[None, bool]]) -> None:
    """Refuse measures that cannot be taken.

    Parameters
    ----------
    contents : Contents
        Content of the deck.
    model : Model
        Its model, with supports.
    at : callable
        Context for a part of the deck by its path, which collects errors.
    """
    released = loading_steps(contents) < len(contents.steps)
    for name, part in contents.measures.items():
        with at("measures", name):
            part.check(model, released=released)
