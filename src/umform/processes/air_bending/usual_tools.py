"""Usual tools of press brakes by name: dies such as V16/88, straight punches such as 88/R0.8."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from typing import Any

from umform.errors import InvalidValue
from umform.processes.air_bending.spec import sizes_of


@dataclass(frozen=True)
class UsualTool:
    """A tool of the list.

    Attributes
    ----------
    kind : str
        "die" or "punch".
    name : str
        V and opening, or the angle of the tip; then the other size.
    sizes : dict of str to float
        Its sizes by the names of the parameters of `AirBending`.
    """

    kind: str
    name: str
    sizes: dict[str, float]


@cache
def usual_tools(kind: str) -> tuple[UsualTool, ...]:
    """All tools of a kind.

    Parameters
    ----------
    kind : str
        "die" or "punch".

    Examples
    --------
    >>> usual_tools("die")[0].name
    'V4/90'
    """
    data = tomllib.loads(files(__package__).joinpath("usual_tools.toml").read_text(encoding="utf-8"))
    if kind == "die":
        return tuple(
            _tool("die", f"V{row['opening']}/{angle}", opening=row["opening"], angle=angle, radius=row["radius"])
            for row in data["dies"]
            for angle in row["angles"]
        )
    return tuple(
        _tool("punch", f"{row['angle']}/R{radius:g}", angle=row["angle"], radius=radius)
        for row in data["punches"]
        for radius in row["radii"]
    )


def usual_tool(kind: str, name: str) -> UsualTool:
    """A tool by its name; capitals, blanks and a decimal comma do not matter.

    Raises
    ------
    InvalidValue
        If there is none.

    Examples
    --------
    >>> usual_tool("punch", "88 / r 0,8").sizes
    {'punch_angle': 88.0, 'punch_radius': 0.8}
    """
    known = {_plain(one.name): one for one in usual_tools(kind)}
    found = known.get(_plain(name))
    if found is None:
        near = [known[one].name for one in get_close_matches(_plain(name), known, n=3, cutoff=0.5)]
        raise InvalidValue(
            f"no usual {kind} has this name",
            where=kind,
            value=name,
            cause=f"did you mean {', '.join(near)}?" if near else "a name of a maker",
            remedy="one of `umform tools`, or its sizes as numbers",
        )
    return found


def _tool(kind: str, name: str, **sizes: float) -> UsualTool:
    names: Any = sizes_of(kind)
    return UsualTool(kind, name, {names[size]: float(value) for size, value in sizes.items()})


def _plain(name: str) -> str:
    return "".join(name.lower().split()).replace(",", ".").replace("°", "")
