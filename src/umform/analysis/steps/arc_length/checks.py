"""Checks of a model for arc-length continuation."""

from __future__ import annotations

from umform.errors import InvalidValue
from umform.model import Model


def refuse_on_an_arc(model: Model, where: str) -> None:
    """Reject multipliers if the load is an unknown: augmentation needs fixed loads.

    Raises
    ------
    InvalidValue
        If a contact has them.
    """
    for contact in model.system.multiplied:
        raise InvalidValue(
            "an arc cannot be followed with multipliers of contact",
            where=where,
            value=f"contact {contact.name}",
            cause="they are found at fixed loads, which a limit point does not have",
            remedy="augmented=False and the penetration that you allow",
        )
