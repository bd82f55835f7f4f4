"""Which steps of a deck release the part."""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.problem.steps import Move

if TYPE_CHECKING:
    from umform.problem.contents import Contents

#: Kinds of steps that release a part.
UNLOADING = ("release", "free")


def loading_steps(contents: Contents) -> int:
    """Number of steps before those at the end that release the part.

    A step that only takes the unbalanced forces of the operation before to zero releases it too.
    """
    forces = {contents.before.control} if contents.before is not None else set()
    count = len(contents.steps)
    while count > 0:
        step = contents.steps[count - 1]
        if step.kind not in UNLOADING and not (isinstance(step, Move) and set(step.to) == forces):
            break
        count -= 1
    return count
