"""The part at the end of a finished run of a deck, from its folder, its state or its checkpoint."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from umform.analysis.run.checkpoint import CHECKPOINT_KIND, read_checkpoint
from umform.errors import FileProblem, InvalidValue
from umform.io.trees import kind_of
from umform.model import Model
from umform.problem.deck_in_checkpoint import Kept
from umform.problem.previous_operation import STATE_KIND, Before
from umform.problem.results import CHECKPOINT, FILES, STATE


@dataclass(frozen=True)
class Finished:
    """The end of a run.

    Attributes
    ----------
    name : str
        Name of the deck, without its suffix.
    model : Model
        The model in the last state.
    units : str
        Units of the deck; empty if it has none.
    """

    name: str
    model: Model
    units: str


def finished(path: Path, stage: str | None = None, trust: bool = False) -> Finished:
    """Rebuild the model of a finished run in its last state.

    Parameters
    ----------
    path : Path
        Folder of the run, its state.h5, or a checkpoint.
    stage : str, optional
        Name of the deck of an earlier operation of the same part; default: the run itself.
    trust : bool
        Whether classes that a deck names may be imported.

    Raises
    ------
    FileProblem
        If the run is not finished, has left no state, or the file cannot be read.
    InvalidValue
        If no operation has this name.
    """
    file, known = _file_of(path), list[str]()
    while True:
        kept = Kept.read(file, trust, STATE_KIND if kind_of(file) == STATE_KIND else CHECKPOINT_KIND)
        name = Path(kept.deck.source.name).stem
        if stage in (None, name):
            return Finished(name, _model(file, kept), _units(kept))
        known.append(name)
        before = kept.deck.contents.before
        if before is None:
            raise InvalidValue(
                "the part has no such stage",
                where="stage",
                value=stage,
                cause="another name",
                remedy="one of " + ", ".join(known),
            )
        file = kept.deck.source.folder / before.state


def _file_of(path: Path) -> Path:
    """The state or the checkpoint of a run."""
    if not path.is_dir():
        if not path.is_file():
            raise FileProblem(
                "there is no such run",
                where=str(path),
                cause="another path, or a run that was removed",
                remedy="the folder of a run, its state.h5, or the file of umform run --checkpoint",
            )
        if kind_of(path) not in (STATE_KIND, CHECKPOINT_KIND):
            raise FileProblem(
                "this file has no state of a run",
                where=str(path),
                cause="a deck or results, which have no stresses at all points",
                remedy="the folder of a run, its state.h5, or the file of umform run --checkpoint",
            )
        return path
    if (path / STATE).is_file():
        return path / STATE
    if (path / CHECKPOINT).is_file():
        raise _unfinished(path / CHECKPOINT)
    if any((path / name).is_file() for name in FILES):
        raise FileProblem(
            "the run has left no state",
            where=str(path),
            cause="its deck has no state = true under [output], or it ended early",
            remedy="umform run DECK --set output.state=true, where DECK is the deck in this folder",
        )
    raise FileProblem(
        "this is no folder of a run",
        where=str(path),
        cause="another folder, or a run that has not begun",
        remedy="the folder that umform run has written",
    )


def _model(file: Path, kept: Kept) -> Model:
    problem = kept.deck.build(kept.chosen_solver)
    if kind_of(file) == STATE_KIND:
        state = Before(deck=kept.deck.source.name, state=file.name)
        state.restore(problem.model, file.parent, kept.deck.source.data)
        return problem.model
    tree = read_checkpoint(file)
    if tree["number"] <= len(problem.steps):
        raise _unfinished(file)
    return problem.resume(file, solver=kept.solver, progress=False).model


def _unfinished(file: Path) -> FileProblem:
    return FileProblem(
        "the run is not finished",
        where=str(file),
        cause="it was stopped between two increments",
        remedy=f"umform resume {file}",
    )


def _units(kept: Kept) -> str:
    units = kept.deck.contents.units
    return ", ".join(filter(None, (units.length, units.force)))
