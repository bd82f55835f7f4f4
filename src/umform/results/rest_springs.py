"""What is said at the end of a run of springs on which a loose sheet has rested."""

from __future__ import annotations

from umform.model import Model
from umform.model.equations.rest_springs import Rest
from umform.results.history import History

#: Energy of the springs over the external work that is no matter.
_NO_MATTER = 1e-6


def tell_of_rest(model: Model, result: History) -> None:
    """Note the energy of the springs; warn if they still act, or if it is a part of the work.

    Parameters
    ----------
    model : Model
        The model at the end.
    result : History
        Gets the note or the warning.
    """
    for term in model.system.others:
        if not isinstance(term, Rest):
            continue
        last = result.rows[-1]
        energy, work = last[f"{term.name}_energy"], abs(last["external_work"])
        said = (
            f"{term.name}: the springs on which the sheet rested have an energy of {energy:.3g}, the work is {work:.3g}"
        )
        if last[f"{term.name}_acts"]:
            result.warn(f"{said}; they still act: tools and supports do not hold the sheet, hold it with fix()")
        elif energy > _NO_MATTER * work:
            result.warn(f"{said}: more than {_NO_MATTER:g} of it; a smaller stiffness of rest(), or a shorter way")
        else:
            result.note(f"{said}; they let go when the tools held the sheet")
