"""Picture of the sizes of elements over a blank, and of its mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from umform.mesh import Mesh
from umform.plotting import COLOUR_MAP, Picture, house_style, save
from umform.surfaces import ToolSizes


def draw_sizes(sizes: ToolSizes, path: str | Path, mesh: Mesh | None = None) -> Figure:
    """Draw sizes as colours, and the elements of a mesh over them.

    Parameters
    ----------
    sizes : ToolSizes
        Result of :func:`umform.surfaces.tool_sizes`.
    path : str or Path
        Picture: .png, .svg or .pdf.
    mesh : Mesh, optional
        The blank.
    """
    figure = sizes_figure(sizes, mesh)
    save(figure, path)
    return figure


def sizes_figure(sizes: ToolSizes, mesh: Mesh | None = None) -> Figure:
    """The picture of :func:`draw_sizes`, not saved."""
    with house_style():
        figure = Picture(figsize=(5.6, 3.8), layout="compressed")
        axes = figure.add_subplot()
        shown = axes.pcolormesh(sizes.x, sizes.y, sizes.size.T, cmap=COLOUR_MAP, shading="gouraud", rasterized=True)
        if mesh is not None:
            quads = mesh.points[mesh.connectivity[:, :4], :2]
            axes.add_collection(PolyCollection(list(quads), facecolors="none", edgecolors="white", linewidths=0.4))
        axes.set_aspect("equal")
        axes.set(xlabel="x", ylabel="y", xlim=np.array(sizes.x)[[0, -1]], ylim=np.array(sizes.y)[[0, -1]])
        bar = figure.colorbar(shown, ax=axes, shrink=0.8)
        bar.set_label("size of elements")
        bar.outline.set_visible(False)
    return figure
