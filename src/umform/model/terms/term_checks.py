"""Reject terms that conflict with others."""

from __future__ import annotations

from collections.abc import Sequence

from umform.errors import InvalidValue
from umform.model.terms.term import Term


def check_term(term: Term, others: Sequence[Term], nodes: int) -> None:
    """Reject a term whose history key is taken, or that couples a node that does not exist."""
    if any(other.key == term.key for other in others):
        raise InvalidValue(
            "the name of a term is taken",
            where=f"term {type(term).__name__}",
            value=f"{term.name!r}",
            cause="two terms of one kind have the same name, and would keep their history in the same place",
            remedy="give it another name",
        )
    for part in term.couples():
        wrong = part.ids[(part.ids < 0) | (part.ids >= nodes)]
        if wrong.size:
            raise InvalidValue(
                "a term couples a node that does not exist",
                where=f"term {type(term).__name__} {term.name!r}",
                value=int(wrong[0]),
                remedy=f"0 to {nodes - 1}",
            )
