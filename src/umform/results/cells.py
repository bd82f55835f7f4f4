"""Report at the beginning of a run on the cells over which contact is integrated."""

from __future__ import annotations

from umform.model import Model
from umform.results.history import History


def tell_of_cells(model: Model, result: History) -> None:
    """Note the number of cells of each pair and the resulting ripple of the force. eq. (4.121)"""
    for contact in model.contacts:
        if contact.cells is None or contact.ripple is None:
            continue
        result.note(
            f"contact {contact.name}: {contact.cells} x {contact.cells} cells a face, "
            f"ripple of the force to expect {100.0 * contact.ripple:.2g} %"
        )
