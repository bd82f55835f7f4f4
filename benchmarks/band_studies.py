"""Errors by the studies: rows of numbers of runs become the largest errors of each number of each process."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from scipy.special import stdtrit

from band_jobs import COARSE, DEFAULT, FINEST, QUICK, SOURCES
from umform.problem.coarser import MESH
from umform.problem.error_budget import SAFETY
from umform.processes.draw.two_meshes import COARSER, EXTRAPOLATED
from umform.processes.extrapolation import Limit
from umform.results.quantity import ALL_BUT_MESH
from umform.results.studies import StudiedMesh, band_of, studied_name

#: Numbers that are counts, thresholds of counts, places of a maximum or given: they have no error.
WITHOUT = (
    "number of ears",
    "ears count from an amplitude of",
    "at a stroke of",
    "off the holder: at a stroke of",
    "stroke",
    "below_die",
    "length_balance",
)
#: Processes of several bends and of single ones.
SEQUENCE, SINGLE = "bend sequence", "air bending"
#: Units of forces, whose errors are relative, so that those of a longer bend are larger.
_FORCES = ("N", "kN", "N/mm", "kN/m")
#: A radius that may be infinite: its errors are relative to the larger one, as those of the curvature are.
_RADIUS = "radius of the wall"
#: Digits that the studies keep.
_DIGITS = 3
#: Share of answers that bands of normally distributed errors contain.
_SHARE = 0.95
#: Powers of the softness that are compared.
_EXPONENTS = tuple(0.05 * number for number in range(21))
#: Errors below this part of the largest one are round-off.
_ROUND_OFF = 1e-12

#: Runs of a part by their names: numbers by their names, units, softness of its bends.
Part = Mapping[str, Mapping[str, Any]]
#: Part, number, and whether the finest answer lies in its band.
Checked = list[tuple[str, str, bool]]


class Change(NamedTuple):
    """Change of a number from a run to another one, what it is relative to; softness and length; its sign, if one."""

    error: float
    value: float
    softness: float
    length: float
    sign: float

    def scaled(self, *, relative: bool, exponent: float) -> float:
        """The error over what it is proportional to."""
        return self.error / self.scale(relative=relative, exponent=exponent)

    def scale(self, *, relative: bool, exponent: float) -> float:
        """What the error is proportional to."""
        power: float = self.softness**exponent
        return (self.value if relative else self.length) * power


def parts_of(rows: Iterable[Mapping[str, Any]], process: str) -> dict[str, Part]:
    """Runs of each part of a process that has a run of its default and of its finest mesh."""
    found: dict[str, dict[str, Mapping[str, Any]]] = {}
    for row in rows:
        if row["process"] == process and not row["error"]:
            found.setdefault(row["job"], {})[row["run"]] = row
    return {name: runs for name, runs in found.items() if DEFAULT in runs and FINEST in runs}


def changes(part: Part, run: str, other: str) -> dict[str, list[Change]]:
    """Changes of each number from a run to another one; several equal features have several."""
    found: dict[str, list[Change]] = {}
    if run not in part or other not in part:
        return found
    units = part.get(DEFAULT, {}).get("units", {})
    for name, value in part[run]["values"].items():
        last = part[other]["values"].get(name)
        if value is not None and last is not None and studied_name(name) not in WITHOUT:
            scale = max(abs(value), abs(last)) if name == _RADIUS else abs(value)
            feature = name.rpartition(": ")[0] if name.startswith("bend ") else ""
            soft = part[run].get("softness", {}).get(feature, 1.0)
            length = part[run].get("length", 1.0) if units.get(name) == "mm" else 1.0
            sign = math.copysign(1.0, value) if value * last > 0.0 else 0.0
            found.setdefault(studied_name(name), []).append(Change(abs(value - last), scale, soft, length, sign))
    return found


def studied(parts: Sequence[Part], units: Mapping[str, str]) -> dict[str, Any]:
    """The rows of the studies of a process, see `umform.results.studies`.

    Errors are normally distributed with a standard deviation that is constant, or proportional to the number, and to a
    power of the softness: whatever is likeliest.

    Parameters
    ----------
    parts : sequence
        Runs of its parts.
    units : mapping of str to str
        Unit of each number.
    """
    base = [changes(part, DEFAULT, FINEST) for part in parts]
    names = dict.fromkeys(name for found in base for name in found)
    every = {name: [pair for found in base for pair in found.get(name, ())] for name in names}
    every = {name: found for name, found in every.items() if any(one.error for one in found)}  # others are given
    soft = any(pair.softness != 1.0 for found in every.values() for pair in found)
    exponent = max(
        _EXPONENTS if soft else _EXPONENTS[:1],
        key=lambda one: sum(_likeliest(found, units.get(name), one)[0] for name, found in every.items()),
    )
    rows = {}
    for name, errors in every.items():
        count = sum(name in found for found in base)
        scale = {"relative": _likeliest(errors, units.get(name), exponent)[1], "exponent": exponent}
        meshes = {mesh: [changes(part, mesh, FINEST) for part in parts] for mesh in (DEFAULT, COARSE)}
        sources = {one: [_of_source(part, one) for part in parts] for one in (*SOURCES, ALL_BUT_MESH)}
        rows[name] = {
            "count": count,
            "factor": round(float(stdtrit(count, 0.5 + 0.5 * _SHARE)), 2),
            "relative": scale["relative"],
            "meshes": _mean_errors(meshes, name, scale),
            "sources": _mean_errors(sources, name, scale),
        }
    return {"parts": len(parts), "exponent": round(exponent, 2), "quantities": rows}


def _mean_errors(
    found: Mapping[str, Sequence[Mapping[str, list[Change]]]], name: str, scale: Mapping[str, Any]
) -> dict[str, float]:
    """Root mean squares of the scaled errors of a number, by the names of its meshes or of its sources."""
    means = {}
    for kind, of_parts in found.items():
        errors = [one for part in of_parts for one in part.get(name, ()) if one.value > 0.0 or not scale["relative"]]
        if errors:
            means[kind] = float(f"{_root_mean_square([one.scaled(**scale) for one in errors]):.{_DIGITS}g}")
    return means


def _root_mean_square(found: Sequence[float]) -> float:
    return math.sqrt(sum(one**2 for one in found) / len(found))


def _likeliest(found: Sequence[Change], unit: str | None, exponent: float) -> tuple[float, bool]:
    """Log-likelihood of errors, and whether they are relative to the values, which have then one sign."""
    kinds = [True] if unit in _FORCES else [False]
    one_sign = {one.sign for one in found} in ({1.0}, {-1.0})
    if unit not in _FORCES and one_sign and all(one.value > 1e-9 for one in found):
        kinds.append(True)
    return max(((_likelihood(found, one, exponent), one) for one in kinds), key=lambda one: round(one[0], 9))


def _likelihood(found: Sequence[Change], relative: bool, exponent: float) -> float:
    scales = [max(one.scale(relative=relative, exponent=exponent), _ROUND_OFF) for one in found]
    deviation = _root_mean_square([one.error / scale for one, scale in zip(found, scales, strict=True)])
    least = _ROUND_OFF * max(1.0, *scales)
    return -len(found) * math.log(max(deviation, least)) - sum(map(math.log, scales))


def _of_source(part: Part, source: str) -> dict[str, list[Change]]:
    """Changes by one source: of the mesh from the default, of others from the coarse one, of all from the fine one."""
    if source == ALL_BUT_MESH:
        return changes(part, "mesh", FINEST)
    return changes(part, DEFAULT if source in ("mesh", "layers") else COARSE, source)


def held_out(parts: Mapping[str, Part], units: Mapping[str, str], mesh: str, process: str) -> Checked:
    """Whether the finest answer of each part lies in its band, estimated from the other parts alone."""
    return [
        one
        for name, part in parts.items()
        for one in inside({name: part}, _without(parts, [name], units), mesh, process)
    ]


def other_half(parts: Mapping[str, Part], units: Mapping[str, str], mesh: str, process: str) -> Checked:
    """The same from the other half of the parts: those at odd places for those at even places, and the reverse."""
    halves = [list(parts)[start::2] for start in (0, 1)]
    if not all(halves):
        return []
    return [
        one
        for half in halves
        for one in inside({name: parts[name] for name in half}, _without(parts, half, units), mesh, process)
    ]


def _without(parts: Mapping[str, Part], names: Sequence[str], units: Mapping[str, str]) -> dict[str, Any]:
    """Studies without some parts."""
    return studied([part for name, part in parts.items() if name not in names], units)


def inside(parts: Mapping[str, Part], studies: Mapping[str, Any], mesh: str, process: str) -> Checked:
    """Whether the finest answers of parts lie in the bands of studies; numbers that those have not are left out."""
    rows, exponent = studies["quantities"], studies["exponent"]
    return [
        (name, number, change.error <= band.error)
        for name, part in parts.items()
        for number, found in changes(part, mesh, FINEST).items()
        for change in found
        if number in rows
        and (at := StudiedMesh(process, mesh, softness=change.softness, length=change.length))
        and (band := band_of(rows[number], exponent, change.value, at, ""))
    ]


def budgets(parts: Mapping[str, Part]) -> Checked:
    """The same for the bands of the error budgets of decks; numbers with an unknown band are left out."""
    checked = []
    for name, part in parts.items():
        coarse = part.get(MESH, part[DEFAULT])["values"]
        changed = {
            run: part[DEFAULT]["values"] if run == MESH else coarse for run in part if run not in (DEFAULT, FINEST)
        }
        for number, value in part[DEFAULT]["values"].items():
            last = part[FINEST]["values"].get(number)
            pairs = [(base.get(number), part[run]["values"].get(number)) for run, base in changed.items()]
            known = [a - b for a, b in pairs if a is not None and b is not None]
            if value is not None and last is not None and len(known) == len(pairs) and any(known):
                checked.append((name, number, abs(value - last) <= SAFETY * math.hypot(*known)))
    return checked


def by_coarse(parts: Mapping[str, Part]) -> Checked:
    """Whether the finest answers lie within the changes from the coarse mesh, with the factor of decks."""
    checked = []
    for name, part in parts.items():
        change = changes(part, DEFAULT, COARSE)
        for number, found in changes(part, DEFAULT, FINEST).items():
            pairs = zip(found, change.get(number, ()), strict=False)
            checked += [(name, number, last.error <= SAFETY * coarse.error) for last, coarse in pairs]
    return checked


def extrapolated(parts: Mapping[str, Part], units: Mapping[str, str]) -> tuple[Checked, Checked]:
    """The same for the bands of two meshes of U-bends; the errors by other sources are from other parts, or a half."""
    halves = [list(parts)[start::2] for start in (0, 1)]
    left_out = _of_two_meshes(parts, [[name] for name in parts], units)
    return left_out, _of_two_meshes(parts, halves, units) if all(halves) else []


def _of_two_meshes(parts: Mapping[str, Part], groups: Sequence[Sequence[str]], units: Mapping[str, str]) -> Checked:
    """Whether the finest answers lie in the bands of two meshes; each group by the studies of the others."""
    checked = []
    for names in groups:
        rows = _without(parts, names, units)["quantities"]
        for name, number in itertools.product(names, EXTRAPOLATED):
            coarse, fine, last = (parts[name][run]["values"].get(number) for run in (QUICK, DEFAULT, FINEST))
            if coarse is None or fine is None or last is None or number not in rows:
                continue
            limit = Limit.of_two(coarse, fine, COARSER)
            other = band_of(rows[number], 0.0, fine, StudiedMesh("u-bend"), "")
            band = limit.band if other is None else limit.band.beside_the_mesh(other)
            checked.append((name, number, abs(last - limit.value) <= band.error))
    return checked
