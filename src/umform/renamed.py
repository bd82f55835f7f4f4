"""Public names of 0.1 that are gone, and what they are now called: each has an error in 0.2, and none in 0.3."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

#: Old name: new name, and how a call changes.
RENAMED = {
    "Term": ("Mode", "modes=(Mode(...), Mode(...) + Mode(...)) in place of tuples of terms"),
}
#: Old module: new module.
MOVED = {
    "umform.calibration": "umform.studies.calibration",
    "umform.deck": "umform.problem, its Deck is Problem, and what build() makes is Prepared",
    "umform.run": "umform.analysis.run",
    "umform.solution": "umform.analysis.newton",
    "umform.steps": "umform.analysis.steps",
    "umform.sweeps": "umform.studies.sweep",
}


def refuse(name: str) -> None:
    """Raise the error of an old name of the facade; others pass.

    Raises
    ------
    ImportError
        Also for ``from umform import ...``, where Python has a text of its own for other errors.
    """
    if name in RENAMED:
        new, remedy = RENAMED[name]
        raise ImportError(f"umform.{name} is now called umform.{new}: {remedy}")


class Moved:
    """Finds no module, but says where those of `MOVED` are."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Refuse an old name.

        Raises
        ------
        ModuleNotFoundError
            With the new name.
        """
        del path, target
        if fullname in MOVED:
            raise ModuleNotFoundError(f"{fullname} is now called {MOVED[fullname]}", name=fullname)
        return None
