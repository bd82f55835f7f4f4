"""Result of a drawing operation: forces, shapes, ears or angles, before and after the tools open."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.elements import element
from umform.errors import InvalidValue
from umform.processes.draw.cup import Cup
from umform.processes.draw.endings import Ending, tears_from
from umform.processes.draw.spec import coarse
from umform.processes.draw.u_bend import UBend
from umform.processes.extrapolation import Limit
from umform.report.symmetry import Mirror, with_images
from umform.results.forming import (
    NUMBER_OF_EARS,
    EarProfile,
    FormingLimit,
    Laid,
    LargestForce,
    Outline,
    PathFields,
    Section,
    UBendAngles,
    distance_from,
    draw_in,
    ear_profile,
    extremes,
    forming_fields,
    largest_force,
    lay_by_best_fit,
    longest_element,
    section,
    u_bend_angles,
)
from umform.results.outcome import Outcome
from umform.results.quantity import Band, Quantity, in_rows
from umform.results.studies import COARSE, DEFAULT, StudiedMesh
from umform.spec import parameters

Floats = NDArray[np.float64]

#: Part of the height of a released wall up to which it is measured: beyond, the edge of the die has bent it.
_HIGHEST = 0.85
#: Names of measures; of the punch force while the holder holds the sheet, and afterwards.
HOLDER, DRAW_IN = "largest holder force", "draw-in, mean"
FORCE, FORCE_OFF = "largest punch force", "off the holder: punch force"
_RIPPLE = "half of the ripple of the force as elements pass the edge of the die"
#: Force of a holder relative to its largest one below which it has let go of the sheet.
_HELD = 0.05


@dataclass(frozen=True, repr=False)
class Drawn(Outcome):
    """A drawn part.

    Attributes
    ----------
    case : Cup or UBend
        The parameters.
    limit : callable
        Forming limit.
    result : Result
        From the open tools to the end of the stroke.
    u : ndarray, shape (3 n,)
        Displacement at the end of the stroke.
    released : Result, optional
        The opening of the tools; None if the run ended earlier.
    ending : Ending, optional
        What went wrong; None if nothing did.
    estimates : mapping of str to Limit
        Measures extrapolated to zero element size; empty for one mesh.
    coarser : Drawn, optional
        The same part on a coarser mesh, that gave the estimates.
    """

    case: Cup | UBend
    limit: FormingLimit
    result: Result
    u: Floats
    released: Result | None
    ending: Ending | None
    estimates: Mapping[str, Limit] = field(default_factory=dict)
    coarser: Drawn | None = None

    @property
    def u_free(self) -> Floats:
        """Displacement of the released part; at the end of the stroke if it was not released."""
        return self.u if self.released is None else self.released.model.u

    @cached_property
    def stroke(self) -> Floats:
        """Travel of the punch in each increment."""
        return self.result["stroke"]

    @cached_property
    def forces(self) -> dict[str, Floats]:
        """Force along the stroke on punch, holder and die of the whole part, in each increment."""
        parts = self.case.parts
        return {name: parts * np.abs(self.result[f"{name}_fz"]) for name in ("punch", "holder", "die")}

    @cached_property
    def punch_force(self) -> LargestForce:
        """Largest force of the punch on the whole part while the holder holds the sheet.

        That of a cup is a mean over the passage of one element; that of a U-bend has its error from two meshes.
        """
        if isinstance(self.case, UBend):
            punch = self.forces["punch"]
            return LargestForce(float(punch.max()), 0.0, float(self.stroke[punch.argmax()]))
        return self._largest(-math.inf, self._let_go)

    @cached_property
    def punch_force_after(self) -> LargestForce | None:
        """The same after the sheet has left the holder, where its rim may be ironed; None if it has not left."""
        free = self.stroke[self.stroke > self._let_go]
        return self._largest(float(free[0]), math.inf) if isinstance(self.case, Cup) and free.size else None

    @property
    def _let_go(self) -> float:
        return let_go(self.stroke, self.forces["holder"])

    def _largest(self, first: float, last: float) -> LargestForce:
        assert isinstance(self.case, Cup)
        way = passage(self.case, self.sections["drawn"])
        return largest_force(self.stroke, self.forces["punch"], way, between=(first, last))

    @cached_property
    def fields(self) -> dict[str, Floats]:
        """Fields of the cells of the part, see :func:`umform.results.forming.forming_fields`."""
        found = forming_fields(self.result.model.mesh, self.u_free, self.limit)
        return found if self.paths is None else found | self.paths.fields

    @cached_property
    def paths(self) -> PathFields | None:
        """Use of the path-dependent forming limit along the states of the drawing; None of a run without states."""
        states = [frame.points["displacement"] for frame in self.result.frames]
        if len(states) < 2:
            return None
        return PathFields.of(self.result.model.mesh, states, self.limit, self.case.material)

    @cached_property
    def outline(self) -> Outline:
        """The edge of the blank before drawing and at the end of the stroke."""
        return draw_in(self.result.model.mesh, self.u, self.case.edge)

    @cached_property
    def ears(self) -> EarProfile:
        """Ears of a cup."""
        if not isinstance(self.case, Cup):
            raise InvalidValue(
                "a U-bend has no ears",
                where="ears",
                cause="a strip in plane strain has no rim",
                remedy="angles of a U-bend, ears of a Cup",
            )
        return ear_profile(self.result.model.mesh, self.u_free)

    @property
    def has_ears(self) -> bool:
        """Whether the rim has ears: a cup without a flange, of a metal with directions.

        In another metal, differences in height are those of the mesh.
        """
        if not isinstance(self.case, Cup) or not getattr(self.case.material, "directional", False):
            return False
        return bool(np.linalg.norm(self.outline.after, axis=1).max() < self.case.throat)

    @cached_property
    def sections(self) -> dict[str, Section]:
        """Section at y = 0 at the end of the stroke and after release."""
        mesh = self.result.model.mesh
        return {"drawn": section(mesh, self.u), "released": section(mesh, self.u_free)}

    @cached_property
    def wall_heights(self) -> tuple[float, float, float] | None:
        """Heights at which the wall of a released U-bend is measured; None without a wall.

        A wall that springs back to below those of the case is measured at the same parts of its height.
        """
        if not isinstance(self.case, UBend) or self.case.heights is None or self.released is None:
            return None
        low, middle, high = self.case.heights
        line = self.sections["released"].middle[:, 2]
        rise = float(line.max() - line[0])
        part = 1.0 if rise > high else _HIGHEST * rise / high
        return part * low, part * middle, part * high

    @cached_property
    def angles(self) -> UBendAngles | None:
        """Angles and radius of a U-bend; None if its wall is too short."""
        if self.wall_heights is None or not isinstance(self.case, UBend):
            return None
        line = self.sections["released"].middle[:, [0, 2]]
        try:
            flat = 0.5 * self.case.punch_width - self.case.punch_edge
            return u_bend_angles(line, self.wall_heights, flange=max(len(line) // 12, 2), flat=flat)
        except InvalidValue:
            return None

    @cached_property
    def punch_distance(self) -> Floats:
        """Distance of the upper face of the part from the punch at the end of its stroke, at the nodes; shape (n,)."""
        return self.distance_from_punch(self.u_free)

    def distance_from_punch(self, u: Floats) -> Floats:
        """The same with another displacement of the nodes; lower nodes have the value of the upper ones."""
        model = self.result.model
        punch = next(tool for tool in model.tools if tool.name == "punch")
        distance = distance_from(punch, model.mesh.displaced(u))
        cells = model.mesh.connectivity
        half = cells.shape[1] // 2
        distance[cells[:, :half]] = distance[cells[:, half:]]
        return distance

    @cached_property
    def springback(self) -> Laid:
        """The whole part, in the best fit to its shape at the end of the stroke.

        The mirror images are fitted with the computed quarter or half, so that it cannot rotate.
        """
        X = self.result.model.mesh.points
        part, places = X + self.u_free.reshape(-1, 3), X + self.u.reshape(-1, 3)
        planes = [Mirror(axis, 0.0) for axis in self.case.mirrored]
        return lay_by_best_fit(with_images(part, planes), with_images(places, planes))

    @property
    def friction_share(self) -> float:
        """Work of friction relative to the external work, in per cent; nan without work."""
        friction, work = (float(self.result[f"{name}_work"][-1]) for name in ("friction", "external"))
        return 100.0 * friction / work if work else math.nan

    @property
    def stages(self) -> dict[str, Result]:
        """Drawing and release, as far as it came."""
        return {"drawing": self.result} | ({} if self.released is None else {"release": self.released})

    @property
    def increments(self) -> int:
        """Number of increments of the drawing."""
        return len(self.result) - 1

    @property
    def warnings(self) -> list[str]:
        """Warnings."""
        own = [] if self.ending is None else [self.ending.text]
        own += self._about_the_force()
        own += self._about_the_paths()
        if isinstance(self.case, UBend) and self.released is not None:
            own += self._about_the_wall()
        if not self.estimates:
            own += coarse(self.case)
        more = [] if self.released is None else self.released.warnings
        return list(dict.fromkeys([*own, *self.case.warnings, *self.result.warnings, *more]))

    def _about_the_force(self) -> list[str]:
        """Notes on the largest force, where the mesh is coarse for it."""
        finer = f"smaller elements: --turn {0.7 * self.case.turn:.2g}"
        force, after = self.punch_force, self.punch_force_after
        found = []
        if force.is_rough:
            found.append(f"the punch force, {_ripple(force)} as elements pass the edge of the die; {finer}")
        if after is not None and after.is_rough and after.value + after.ripple > force.value:
            found.append(
                f"the punch force off the holder, {_ripple(after)}: it is that of the mesh, the rim is ironed row by "
                f"row; {finer}, or a wider opening of the die"
            )
        return found

    def _about_the_paths(self) -> list[str]:
        """Note on paths that bend near a limit."""
        text = None if self.paths is None else self.paths.warning(self.result.model.mesh)
        return [] if text is None else [text]

    def _about_the_wall(self) -> list[str]:
        """Notes on the angles of a U-bend that are left out or measured elsewhere."""
        if self.angles is None or self.wall_heights is None:
            return ["theta1, theta2 and the radius of the wall are left out: the wall is too short"]
        if self.wall_heights == self.case.heights:  # type: ignore[union-attr]
            return []
        heights = ", ".join(f"{height:.3g}" for height in self.wall_heights)
        return [f"the wall has sprung back below the usual heights: its angles and radius are those at {heights} mm"]

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        return self.case.title

    @property
    def quantities(self) -> list[Quantity]:
        """Measures of the part: those of forming, then those of a cup or of a U-bend."""
        punch, after = self.punch_force, self.punch_force_after
        torn, bands = tears_from(self.result), self._bands
        rows = [
            Quantity(FORCE, "kN", value=punch.value / 1000.0, leading=True),
            Quantity("at a stroke of", "mm", value=punch.stroke),
            *(
                []
                if after is None
                else [
                    Quantity(FORCE_OFF, "kN", value=after.value / 1000.0),
                    Quantity("off the holder: at a stroke of", "mm", value=after.stroke),
                ]
            ),
            Quantity(HOLDER, "kN", value=float(self.forces["holder"].max()) / 1000.0),
            Quantity(DRAW_IN, "mm", value=self.outline.mean(), leading=True),
            *extremes(self.fields),
            Quantity("work of friction", "% of the work", value=self.friction_share),
            *([Quantity("stroke at the forming limit", "mm", value=torn)] if math.isfinite(torn) else []),
            *(
                []
                if self.released is None
                else [Quantity("largest springback", "mm", value=self.springback.largest, leading=True)]
            ),
            *(self._of_cup() if isinstance(self.case, Cup) else self._of_u_bend()),
        ]
        banded = self.banded([replace(one, band=bands.get(one.name)) for one in rows])
        return [replace(one, of_mesh=one.band is None) for one in banded]

    @property
    def studied(self) -> StudiedMesh | None:
        """Mesh beside those of the studies, by the angle that an element turns; of a U-bend its element counts.

        None for what the studies of the process have not: other elements, layers of 8-node elements in a U-bend, a
        holder that keeps its distance.
        """
        case = self.case
        coarse = type(case).meshes["coarse"]
        small = element(case.element).cell == "hex8"
        if isinstance(case, Cup) and not (small and case.holder_force is not None):
            return None
        if small and isinstance(case, UBend):
            found = StudiedMesh(case.kind, COARSE, case.turn / coarse["turn"])
            return replace(found, length=case.thickness) if case.stacked == 1 else None
        spec: type = type(case)
        usual = parameters(spec)["turn"].default
        if isinstance(case, UBend):
            found = StudiedMesh(case.kind, DEFAULT, case.turn / usual)
        else:
            found = StudiedMesh.nearest(case.kind, case.turn / usual, coarse["turn"] / usual)
        return replace(found, length=case.thickness)

    def _of_cup(self) -> list[Quantity]:
        heights = [
            Quantity(name, "mm", value=height, leading=name.endswith("mean"))
            for name, height in self.ears.heights().items()
        ]
        if not self.has_ears:
            return heights
        waves = [Quantity(name, "mm", value=amplitude) for name, amplitude in self.ears.waves().items()]
        return [*heights, *waves, Quantity(NUMBER_OF_EARS, value=float(len(self.ears.ears())))]

    def _of_u_bend(self) -> list[Quantity]:
        if self.angles is None:
            return []
        return [
            Quantity("theta1", "degrees", value=self.angles.theta1, leading=True),
            Quantity("theta2", "degrees", value=self.angles.theta2, leading=True),
            Quantity("radius of the wall", "mm", value=self.angles.radius, leading=True),
        ]

    @property
    def _bands(self) -> dict[str, Band]:
        """Errors by name: those of two meshes, or the ripple of a force by one mesh."""
        ripples = {FORCE: self.punch_force, FORCE_OFF: self.punch_force_after} if isinstance(self.case, Cup) else {}
        known = {name: Band(force.ripple / 1000.0, _RIPPLE) for name, force in ripples.items() if force is not None}
        return known | {name: limit.band for name, limit in self.estimates.items()}

    @property
    def tables(self) -> dict[str, list[list[str]]]:
        """The measures, and those of each mesh that gave the estimates."""
        return super().tables | ({"Meshes": in_rows(list(map(self._on, self._meshes)))} if self.estimates else {})

    @property
    def _meshes(self) -> tuple[Drawn, ...]:
        return (self,) if self.coarser is None else (self.coarser, self)

    def _on(self, mesh: Drawn) -> list[Quantity]:
        elements = len(mesh.result.model.mesh.connectivity)
        size = [Quantity("degrees per element", value=mesh.case.turn), Quantity("elements", decimals=0, value=elements)]
        return [*size, *(replace(mesh[name], band=None) for name in self.estimates)]

    @property
    def notes(self) -> list[str]:
        """How errors of this part are found."""
        return list(filter(None, [self.about_errors]))

    @property
    def about_errors(self) -> str:
        """Note on errors that are estimated from other parts; empty for two meshes."""
        if self.estimates:
            return ""
        text = f"values of one mesh, whose elements turn up to {self.case.turn:g} degrees"
        if isinstance(self.case, UBend) and self.ending is None and self.angles is not None:
            return f"{text}; two meshes give errors of this part: umform draw u --extrapolate"
        if isinstance(self.case, UBend):
            return f"{text}; repeat with elements that turn half as far to see errors of this part"
        return f"{text}; repeat with half of --turn, and twice --around, to see errors of this part"


def passage(case: Cup, cut: Section) -> float:
    """Travel of the punch in which the longest element of a drawn part passes the edge of the die."""
    return longest_element(cut, case.sizes.ends, case.sizes.bent[-1].start)


def let_go(stroke: Floats, holder: Floats) -> float:
    """Last stroke at which the holder holds the sheet; infinite if it never does."""
    held = np.flatnonzero(holder > _HELD * holder.max())
    return float(stroke[held[-1]]) if len(held) else math.inf


def _ripple(force: LargestForce) -> str:
    return f"{force.value / 1000.0:.3g} kN, ripples by ± {force.ripple / 1000.0:.2g} kN"
