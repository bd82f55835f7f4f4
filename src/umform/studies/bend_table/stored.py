"""One bend to an angle: from the store, or from a run that goes into the store."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from umform.analysis.run.fingerprint import text
from umform.digest import floats
from umform.errors import InvalidValue, SolveError, UmformError
from umform.io.store import Entry, Store, key_of
from umform.problem.keys import law_keys
from umform.problem.own_classes import modules_of
from umform.processes.air_bending.brake import Brake
from umform.processes.air_bending.goal import Goal, check_angle
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.problem import problem_of
from umform.processes.air_bending.remarks import coarse_mesh, extrapolated
from umform.processes.air_bending.search import bent_to_angle
from umform.processes.air_bending.spec import AirBending
from umform.spec import check_arguments, check_value

#: Kind of the entries, and version of their numbers: increase it with any change of the code that changes a bend.
KIND, RESULTS = "bend", 2
Store.versions[KIND] = RESULTS
#: Tolerance of the angle in degrees: 0.0003 mm of bend allowance at R + K T = 3 mm.
TOLERANCE = 0.005
#: Range of the angle between the legs in degrees.
LEAST, MOST = 15.0, 165.0


@dataclass(frozen=True)
class StoredBend:
    """A bend to an angle.

    Attributes
    ----------
    case : AirBending
        Sheet and tools, with the stroke that leaves the angle.
    wanted : float
        Angle between the legs in degrees; `measures.angle` is within the tolerance of it.
    measures : Measures
        What the run gave; docs/air-bending.md defines them.
    notes : tuple of str
        Remarks on the run, such as a coarse mesh.
    key : str
        Name in the store.
    computed : bool
        Whether it was computed now.
    """

    case: AirBending
    wanted: float
    measures: Measures
    notes: tuple[str, ...] = ()
    key: str = ""
    computed: bool = False

    @property
    def bend_angle(self) -> float:
        """Angle by which the sheet is bent, in degrees: 180 less the angle between the legs."""
        return 180.0 - self.wanted

    @property
    def radius(self) -> float:
        """Inside radius after unloading in mm."""
        return self.measures.radius

    @property
    def k_factor(self) -> float:
        """K of ANSI: the neutral line is K T from the inner face."""
        return self.measures.k_factor

    @property
    def k_din(self) -> float:
        """Factor of DIN 6935: the neutral line is k T / 2 from the inner face."""
        return 2.0 * self.measures.k_factor

    @property
    def allowance(self) -> float:
        """Bend allowance BA in mm: flat length less the straight legs."""
        return self.measures.bend_allowance

    @property
    def deduction(self) -> float:
        """Bend deduction BD in mm: sides to where the lines of the outer faces meet, less the flat length."""
        return self.measures.bend_deduction

    @property
    def tangent_deduction(self) -> float:
        """Bend deduction with sides to the tangent across the bend, as DIN 6935 has it below 90 degrees."""
        return 2.0 * (self.radius + self.case.thickness) - self.allowance

    @property
    def outside(self) -> float:
        """Length of each side of the run in mm, to where the lines of the outer faces meet."""
        return self.measures.leg + self.measures.setback

    @property
    def flat_length(self) -> float:
        """Length of the flat sheet of the run in mm."""
        return 2.0 * self.outside - self.deduction


def bend(
    case: AirBending, angle: float, *, tolerance: float = TOLERANCE, store: Store | None = None, solver: str = "auto"
) -> StoredBend:
    """A bend to an angle after springback, from the store, or else from a run.

    Parameters
    ----------
    case : AirBending
        Sheet and tools; the stroke is not used.
    angle : float
        Angle between the legs in degrees, 15 to 165.
    tolerance : float
        Largest deviation of the angle in degrees.
    store : Store, optional
        Default: that of the user.
    solver : str
        Sparse solver.

    Raises
    ------
    InvalidValue
        The tools cannot bend to the angle in the air.
    NoConvergence
        The sheet cannot be bent so far.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending
    >>> found = bend(AirBending(thickness=1.0, opening=8.0), 120.0)  # doctest: +SKIP
    >>> found.allowance  # doctest: +SKIP
    """
    check_arguments(bend, case=case, angle=angle)
    (found,) = bends(case, [angle], tolerance=tolerance, store=store, solver=solver)
    return found


def bends(
    case: AirBending,
    angles: Sequence[float],
    *,
    tolerance: float = TOLERANCE,
    store: Store | None = None,
    solver: str = "auto",
    each: Callable[[StoredBend], None] = lambda found: None,
    on_failure: Callable[[float, UmformError], None] | None = None,
) -> list[StoredBend]:
    """Bends to several angles; those that are not stored share one loading.

    Parameters
    ----------
    case, tolerance, store, solver
        As for :func:`bend`.
    angles : sequence of float
        Angles between the legs in degrees.
    each : callable
        Called with each bend when it is there.
    on_failure : callable, optional
        Called with an angle that the run does not reach, and the error; the others go on. Without it the error is
        raised.

    Returns
    -------
    list of StoredBend
        In the order of the angles, without those that failed.
    """
    check_arguments(bends, case=case, angles=angles, store=store, solver=solver)
    store = Store() if store is None else store
    for angle in angles:
        check_bend(case, angle, tolerance)
    found: dict[float, StoredBend] = {}
    brakes: list[Brake] = []
    for angle in sorted(set(angles), reverse=True):  # from flat to sharp: each continues the previous loading
        entry = store.get(key := bend_key(case, angle, tolerance, solver))
        try:
            if entry is None:
                found[angle] = _run(case, angle, tolerance, solver, brakes, key, store)
            else:
                found[angle] = _of(case, angle, entry)
        except (InvalidValue, SolveError) as error:
            if on_failure is None:
                raise
            on_failure(angle, error)
        else:
            each(found[angle])
    return [found[angle] for angle in angles if angle in found]


def stored_bends(
    case: AirBending,
    angles: Sequence[float],
    *,
    tolerance: float = TOLERANCE,
    store: Store | None = None,
    solver: str = "auto",
) -> list[StoredBend]:
    """Those bends that are in the store; no bend is run.

    Parameters
    ----------
    case, angles, tolerance, store, solver
        As for :func:`bends`.

    Returns
    -------
    list of StoredBend
        In the order of the angles.
    """
    check_arguments(stored_bends, case=case, angles=angles, tolerance=tolerance, store=store, solver=solver)
    store = Store() if store is None else store
    entries = [(angle, store.get(bend_key(case, angle, tolerance, solver))) for angle in angles]
    return [_of(case, angle, entry) for angle, entry in entries if entry is not None]


def check_bend(case: AirBending, angle: float, tolerance: float = TOLERANCE) -> None:
    """Refuse what air bending with these tools cannot reach.

    Raises
    ------
    InvalidValue
    """
    check_value(Goal, "tolerance", tolerance)
    if not LEAST <= angle <= MOST:
        raise InvalidValue(
            "the flat length of a bend is computed for 15 to 165 degrees between its legs",
            where="angle",
            value=angle,
            cause="a flatter or a sharper bend, the angle by which the sheet is bent, or radians",
            remedy="180 degrees less the bend angle; a K-factor or a table for the flat pattern of such a bend",
        )
    if case.bottoming:
        raise InvalidValue(
            "the angle of bottoming follows from force and die",
            where="bottoming",
            value=True,
            remedy="air bending: bottoming=False",
        )
    check_angle(case, angle)


def bend_key(case: AirBending, angle: float, tolerance: float = TOLERANCE, solver: str = "auto") -> str:
    """Name of a bend in the store: digest of its problem and of the search."""
    check_arguments(bend_key, case=case, angle=angle, tolerance=tolerance, solver=solver)
    problem = problem_of(replace(case, stroke=None), case.largest_stroke)
    data = problem.source.data
    own = [text(case.sheets)] if modules_of(data) else []  # a class of the user, whose name says nothing of its code
    return key_of(KIND, RESULTS, text([floats(data), float(angle), float(tolerance), solver, *own]))


def _run(
    case: AirBending, angle: float, tolerance: float, solver: str, brakes: list[Brake], key: str, store: Store
) -> StoredBend:
    if not brakes:
        brakes.append(Brake(case, solver))
    state, measures, _ = bent_to_angle(brakes[0], angle, tolerance)
    if math.isnan(measures.k_factor):
        raise InvalidValue(
            "the sheet springs back flat: a bend has no radius and no K-factor",
            where="angle",
            value=angle,
            remedy="a sharper bend, or a narrower die",
        )
    notes = (*coarse_mesh(case), *extrapolated(case, measures.outer_strain))
    store.put(key, KIND, _about(case, angle, tolerance), asdict(measures) | {"notes": list(notes)}, RESULTS)
    return StoredBend(replace(case, stroke=state.stroke), angle, measures, notes, key, computed=True)


def _of(case: AirBending, angle: float, entry: Entry) -> StoredBend:
    numbers = {"below_die": entry.value["stroke"] - case.thickness} | dict(entry.value)  # older entries lack it
    notes = tuple(numbers.pop("notes"))
    return StoredBend(replace(case, stroke=numbers["stroke"]), angle, Measures(**numbers), notes, entry.key)


def plain(case: AirBending) -> dict[str, int | float | str]:
    """Parameters of a setup that are numbers or words; the stroke is that of a bend."""
    return {
        name: value
        for name, value in case.record().items()
        if isinstance(value, int | float | str) and name not in ("stroke", "bottoming")
    }


def _about(case: AirBending, angle: float, tolerance: float) -> dict[str, Any]:
    """Input of a bend as readable data."""
    rolling = None if case.rolling is None else {"angle": float(case.rolling)}
    return {"angle": angle, "tolerance": tolerance, **plain(case), "material": _words(law_keys(case.material, rolling))}


def _words(value: Any) -> Any:
    """Data of JSON; other objects as text."""
    if isinstance(value, dict):
        return {name: _words(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_words(one) for one in value]
    return value if value is None or isinstance(value, bool | int | float | str) else text(value)
