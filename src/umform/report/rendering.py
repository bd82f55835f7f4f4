"""Pictures of formed parts between their tools, drawn by PyVista (extra ``view``), off screen or in a window."""

from __future__ import annotations

import importlib
import io
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

from umform.errors import UmformError
from umform.plotting import COLOUR_MAP
from umform.report import looks
from umform.report.facets import smooth_groups, unit_normals
from umform.report.looks import LINES, ROLLING, SHEET, TOOL, TOOL_OPACITY
from umform.report.skin import Skin
from umform.surfaces.triangles import Triangles
from umform.surfaces.triangulated import SHARP

Floats = NDArray[np.float64]

#: Azimuth and elevation of the observer in degrees.
VIEW = (-118.0, 26.0)
#: Colour of a section of a tool.
SECTION = "#8797a8"
#: Pixels in a picture for one that is kept, along each side.
_FINER = 2
#: Margin around what is drawn, as a part of its size.
_MARGIN = 0.02
#: Dots per inch and size of the font; room for a scale, its largest height, room for titles, in pixels.
_DPI, _FONT, SCALE, _TALL_SCALE, _TITLE = 100, 12, 110, 420, 36
#: Difference of colours out of 255 that is dithered.
_VISIBLE = 3
#: Bytes of a file from which on it has 256 colours only.
_LARGEST = 190_000
#: Height over width of a picture, at most.
_LARGEST_ASPECT = 0.8
#: Scale in a window.
_BAR = {
    "vertical": True,
    "position_x": 0.86,
    "position_y": 0.3,
    "width": 0.05,
    "height": 0.4,
    "color": "#222222",
    "title_font_size": 20,
    "label_font_size": 18,
    "fmt": "%.3g",
}


def pyvista(where: str, *, off_screen: bool) -> Any:
    """PyVista, or an error with the cause why it cannot be used.

    Parameters
    ----------
    where : str
        What asks for it, for the error.
    off_screen : bool
        Whether no window is opened.

    Raises
    ------
    UmformError
        PyVista is missing, or there is no screen for a window.
    """
    screen = sys.platform != "linux" or "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
    if not screen and not off_screen:
        raise UmformError(
            "there is no screen to open a window on",
            where=where,
            cause="neither DISPLAY nor WAYLAND_DISPLAY is set",
            remedy="--png picture.png writes a picture",
        )
    try:
        pv = importlib.import_module("pyvista")
        log = importlib.import_module("vtkmodules.vtkCommonCore").vtkLogger
    except ImportError as error:
        raise UmformError(
            f"{where} needs PyVista",
            where=where,
            cause=str(error),
            remedy='pip install "umform[view]"; the page of result.report() needs a browser only',
        ) from error
    if not screen:  # VTK tries an X server first, and complains without one
        log.SetStderrVerbosity(log.VERBOSITY_ERROR)
    return pv


@dataclass(frozen=True)
class Scale:
    """The scale of a field.

    Attributes
    ----------
    label : str
        Name and unit.
    limits : tuple of float
        Lowest and highest value.
    """

    label: str
    limits: tuple[float, float]


@dataclass(frozen=True)
class Cut:
    """A plane before which tools are cut away.

    Attributes
    ----------
    normal, at : tuple of float
        Unit normal to the side that is left, and a point.
    depth : float
        Height of the section behind the highest or lowest point of the tool: a tool is its surface only.
    """

    normal: tuple[float, float, float]
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    depth: float = 0.0


class Rendering:
    """What is drawn, seen in parallel projection.

    Parameters
    ----------
    where : str
        What asks for the picture, for errors.
    view : tuple of float
        Azimuth and elevation of the observer in degrees.
    off_screen : bool
        Whether it becomes a file and not a window.
    """

    def __init__(self, where: str, view: tuple[float, float] = VIEW, *, off_screen: bool = True) -> None:
        from umform.plotting import camera

        self.pv = pyvista(where, off_screen=off_screen)
        self.plotter = self.pv.Plotter(off_screen=off_screen, lighting="none", window_size=(1200, 800))
        self.plotter.set_background("white")
        self._towards, self._across, self._up = camera(*view)
        self._extent: list[Floats] = []
        self._sheet: Any = None
        self._scale: Scale | None = None
        self._lights()

    def add_sheet(
        self,
        skin: Skin,
        scale: Scale | None = None,
        *,
        lines: bool = True,
        colour: str = SHEET,
        opacity: float = 1.0,
    ) -> None:
        """Add a sheet, coloured by the values of its skin if there is a scale, with the lines of its elements."""
        surface = self._surface(skin.points, skin.quads, skin.normals)
        colours: dict[str, Any] = {"color": colour}
        if scale is not None and skin.values is not None:
            surface.point_data["values"] = skin.values
            colours = {"scalars": "values", "cmap": COLOUR_MAP, "clim": scale.limits, "nan_color": SHEET}
        self._sheet = self._add(surface, **colours, opacity=opacity, **_shine(looks.SHEET_SHINE))
        self._scale = scale
        self._extent.append(skin.points)
        if lines:
            for some in skin.lines:
                self._add_lines(some, LINES, 1.0, looks.LINE_OPACITY * opacity)

    def add_tool(
        self, surface: Triangles, *, cut: Cut | None = None, colour: str = TOOL, opacity: float = TOOL_OPACITY
    ) -> None:
        """Add a tool, smooth except at its edges; what is before a cut is left out, and a section is drawn."""
        if cut is not None:
            surface = surface.beyond(cut.normal, cut.at)
        if not len(surface.triangles):
            return
        groups = smooth_groups(surface.points, surface.triangles)
        own = np.repeat(surface.area_vectors, 3, axis=0)
        n = int(groups.max()) + 1
        total = np.stack([np.bincount(groups.ravel(), own[:, c], n) for c in range(3)], axis=1)
        points = np.empty((n, 3))
        points[groups] = surface.corners
        size = np.linalg.norm(total, axis=1, keepdims=True)
        normals = np.divide(total, size, out=np.zeros_like(total), where=size > 0)
        points = self._nearer(points, looks.TOOLS_BEFORE)
        self._add(self._surface(points, groups, normals), color=colour, opacity=opacity, **_shine(looks.TOOL_SHINE))
        edges, free = creases(surface)
        self._add_lines(edges, LINES, 1.0, looks.EDGE_OPACITY)
        self._extent.append(surface.points)
        if cut is not None:
            self._add_sides(surface, edges[free], cut, colour)

    def _add_sides(self, surface: Triangles, edges: Floats, cut: Cut, colour: str) -> None:
        """Add faces from the free edges of a tool to the height of its back: the section, and the other sides."""
        upwards = surface.area_vectors[:, 2].sum() > 0.0
        z = surface.points[:, 2]
        back = z.min() - cut.depth if upwards else z.max() + cut.depth
        far = edges.copy()
        far[:, :, 2] = back
        sides = np.stack([edges[:, 0], edges[:, 1], far[:, 1], far[:, 0]], axis=1)
        on = (np.abs((edges - np.asarray(cut.at)) @ np.asarray(cut.normal)) < 1e-6 * np.ptp(z)).all(axis=1)
        lit = {"color": colour, "ambient": looks.AMBIENT}
        for some, look in ((sides[on], {"color": SECTION, "lighting": False}), (sides[~on], lit)):
            if len(some):
                self._add_flat(some.reshape(-1, 3), np.arange(4 * len(some)).reshape(-1, 4), look)
        behind = surface.points.copy()
        behind[:, 2] = back
        self._add_flat(behind, surface.triangles[:, ::-1], lit)

    def _add_flat(self, points: Floats, faces: NDArray[np.int64], look: dict[str, Any]) -> None:
        """Add faces without normals."""
        cells = np.insert(faces, 0, faces.shape[1], axis=1).ravel()
        self.plotter.add_mesh(self.pv.PolyData(self._nearer(points, looks.TOOLS_BEFORE), cells), **look)
        self._extent.append(points)

    def add_rolling(self, skin: Skin, directions: Floats) -> None:
        """Add a line along the rolling direction of each element (m, 3); a button in the window switches them."""
        lines = self._add_lines(rolling_lines(skin, directions), ROLLING, 2.0, 1.0)
        if lines is not None and not self.plotter.off_screen:
            self.plotter.add_checkbox_button_widget(lines.SetVisibility, value=True, size=24, color_on=ROLLING)
            self.plotter.add_text("rolling direction", position=(42, 10), font_size=9, color="#222222")

    def show(self, title: str) -> None:
        """Open a window."""
        if self._scale is not None:
            self.plotter.add_scalar_bar(self._scale.label + "\n", mapper=self._sheet.mapper, **_BAR)
        self.plotter.view_vector(self._towards, viewup=(0.0, 0.0, 1.0))
        self.plotter.enable_parallel_projection()
        self.plotter.show(title=title)

    def image(self, width: int = 1200 - SCALE) -> NDArray[np.uint8]:
        """The picture as pixels (height, width, 3), which what is drawn fills."""
        points = np.concatenate(self._extent)
        flat = points @ np.stack([self._across, self._up], axis=1)
        low, high = flat.min(axis=0), flat.max(axis=0)
        size = (high - low) * (1.0 + 2.0 * _MARGIN)
        size[0] = max(size[0], size[1] / _LARGEST_ASPECT)
        height = round(width * float(size[1] / size[0]))
        middle, reach = 0.5 * (low + high), float(np.ptp(points, axis=0).max())
        camera = self.plotter.camera
        focus = middle @ np.stack([self._across, self._up]) + self._towards * (points @ self._towards).mean()
        camera.focal_point, camera.position = focus, focus + 10.0 * reach * self._towards
        camera.up, camera.parallel_projection, camera.parallel_scale = self._up, True, 0.5 * float(size[1])
        self.plotter.window_size = (_FINER * width, _FINER * height)
        self.plotter.reset_camera_clipping_range()
        from PIL import Image

        pixels = Image.fromarray(np.asarray(self.plotter.screenshot(return_img=True)))
        self.plotter.close()
        return np.asarray(pixels.resize((width, height), Image.Resampling.LANCZOS))

    def _lights(self) -> None:
        """Lights that move with the camera."""
        for place, strength in looks.LIGHTS:
            self.plotter.add_light(self.pv.Light(position=place, intensity=strength, light_type="camera light"))

    def _nearer(self, points: Floats, part: float) -> Floats:
        """Points moved to the observer by a part of their size, which a parallel projection does not show."""
        moved: Floats = points + part * float(np.ptp(points.reshape(-1, 3), axis=0).max()) * self._towards
        return moved

    def _surface(self, points: Floats, faces: NDArray[np.int64], normals: Floats) -> Any:
        surface = self.pv.PolyData(points, np.insert(faces, 0, faces.shape[1], axis=1).ravel())
        surface.point_data["Normals"] = normals
        surface.point_data.active_normals_name = "Normals"
        return surface

    def _add(self, surface: Any, **options: Any) -> Any:
        return self.plotter.add_mesh(
            surface,
            smooth_shading=True,
            split_sharp_edges=False,
            ambient=looks.AMBIENT,
            show_scalar_bar=False,
            **options,
        )

    def _add_lines(self, lines: Floats, colour: str, width: float, opacity: float) -> Any:
        """Lines (l, s, 3), drawn before the faces they lie on."""
        if not len(lines):
            return None
        count, each = lines.shape[:2]
        cells = np.insert(np.arange(count * each).reshape(count, each), 0, each, axis=1).ravel()
        drawn = self.pv.PolyData(self._nearer(lines.reshape(-1, 3), looks.LINES_BEFORE), lines=cells)
        width *= _FINER if self.plotter.off_screen else 1
        return self.plotter.add_mesh(
            drawn, color=colour, line_width=width, opacity=opacity, lighting=False, show_scalar_bar=False
        )


def _shine(how: tuple[float, float]) -> dict[str, float]:
    """How a surface shines."""
    return {"specular": how[0], "specular_power": how[1]}


def creases(surface: Triangles) -> tuple[Floats, NDArray[np.bool_]]:
    """Sharp and free edges of a tool, shape (l, 2, 3), and which of them are free."""
    normals = unit_normals(surface.points, surface.triangles)
    ends = np.sort(surface.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(surface.triangles)), 3)
    edges, number, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    total = np.stack([np.bincount(number.ravel(), normals[owner, c], len(edges)) for c in range(3)], axis=1)
    sharp = (count == 1) | (np.linalg.norm(total, axis=1) < 2.0 * np.cos(np.radians(0.5 * SHARP)))
    return surface.points[edges[sharp]], count[sharp] == 1


def rolling_lines(skin: Skin, directions: Floats) -> Floats:
    """Lines (l, 2, 3) along the rolling directions (m, 3) of the elements, on the faces that they lie in."""
    along, normal = directions[skin.owners], skin.directions
    flat = along - np.einsum("fi,fi->f", along, normal)[:, None] * normal
    length = np.linalg.norm(flat, axis=1)
    seen = length > looks.LYING
    size = np.sqrt(skin.areas)[seen, None]
    arm = looks.ROLLING_LENGTH * size * flat[seen] / length[seen, None]
    middle = skin.middles[seen] + looks.ROLLING_BEFORE * size * normal[seen]
    return np.stack([middle - arm, middle + arm], axis=1)


def scaled(skin: Skin, label: str, limits: tuple[float, float] | None = None) -> Scale:
    """The scale of the values of a skin."""
    known = np.zeros(1) if skin.values is None else skin.values[np.isfinite(skin.values)]
    return Scale(label, limits or (float(known.min(initial=np.inf)), float(known.max(initial=-np.inf))))


@dataclass(frozen=True)
class Panel:
    """One view in a picture.

    Attributes
    ----------
    pixels : ndarray of uint8, shape (height, width, 3)
        What `Rendering.image` gives.
    scale : Scale or None
        Drawn at its right.
    title : str
        Written above.
    """

    pixels: NDArray[np.uint8]
    scale: Scale | None = None
    title: str = ""


def write_picture(path: Path, panels: Sequence[Panel]) -> Path:
    """Write views side by side, with their scales and titles, as a PNG, atomically; a large one has 256 colours."""
    from matplotlib.figure import Figure
    from PIL import Image

    from umform.io.atomic import PendingFile
    from umform.plotting import house_style

    above = _TITLE if any(panel.title for panel in panels) else 0
    widths = [panel.pixels.shape[1] + (SCALE if panel.scale else 0) for panel in panels]
    width, inner = sum(widths), max(panel.pixels.shape[0] for panel in panels)
    height = inner + above
    with house_style():
        figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI)
        left = 0
        for panel, wide in zip(panels, widths, strict=True):
            h, w = panel.pixels.shape[:2]
            figure.figimage(panel.pixels, left, (inner - h) // 2, origin="upper")
            if panel.title:
                middle = (left + 0.5 * w) / width
                figure.text(middle, 1.0 - 0.55 * above / height, panel.title, ha="center", va="center", fontsize=_FONT)
            if panel.scale:
                tall = min(0.72 * inner, _TALL_SCALE)
                place = ((left + w + 8) / width, (0.5 * (inner - tall)) / height, 16 / width, tall / height)
                norm = mpl.colors.Normalize(*panel.scale.limits)
                bar = figure.colorbar(mpl.cm.ScalarMappable(norm, COLOUR_MAP), cax=figure.add_axes(place))
                bar.ax.tick_params(labelsize=_FONT - 1, length=3)
                bar.locator = mpl.ticker.MaxNLocator(5)
                bar.set_label(panel.scale.label, fontsize=_FONT, labelpad=6)
                bar.outline.set_visible(False)
            left += wide
        file = io.BytesIO()
        figure.savefig(file, format="rgba", dpi=_DPI)
    drawn = Image.frombytes("RGBA", (width, height), file.getvalue()).convert("RGB")
    file = io.BytesIO()
    drawn.save(file, format="png", optimize=True)
    if file.tell() > _LARGEST:
        file = io.BytesIO()
        _few_colours(drawn).save(file, format="png", optimize=True)
    with PendingFile(path) as temporary:
        temporary.write_bytes(file.getvalue())
    return path


def _few_colours(picture: Any) -> Any:
    """A picture in 256 colours, dithered where the nearest of them is visibly another; white remains white."""
    from PIL import Image

    near = picture.quantize(256, Image.Quantize.MEDIANCUT, kmeans=1)
    dithered = picture.quantize(palette=near, dither=Image.Dither.FLOYDSTEINBERG)
    colours = np.array(near.getpalette(), dtype=np.int64).reshape(-1, 3)
    ids = np.asarray(picture.quantize(palette=near, dither=Image.Dither.NONE))
    off = np.abs(colours[ids] - np.asarray(picture, dtype=np.int64)).max(axis=2) > _VISIBLE
    few = Image.fromarray(np.where(off, np.asarray(dithered), ids).astype(np.uint8), mode="P")
    colours[ids[0, 0]] = 255
    few.putpalette(colours.ravel().tolist())
    return few
