"""What every process records of its runs: penetration of the contacts, balance of forces and energies."""

from __future__ import annotations

from collections.abc import Mapping

from umform.results.balance_summary import balanced
from umform.results.history import History
from umform.results.penetration import contact_record


def run_record(stages: Mapping[str, History]) -> dict[str, dict[str, object]]:
    """Contacts and balance of each stage of a process as JSON data.

    Parameters
    ----------
    stages : mapping of str to History
        The runs of the process by their names, in order.
    """
    balances = {name: balanced(result) for name, result in stages.items()}
    return {
        "contacts": contact_record(stages),
        "balance": {name: one.record() for name, one in balances.items() if one is not None},
    }
