"""Pictures of all tools: each as a solid, and the sections of the press brake with their dimensions."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import umform as uf
from umform.plotting import COLOURS, INK, house_style, save
from umform.surfaces import Tool

BOX = ((-7.0, -4.0, -6.0), (7.0, 4.0, 5.0))
MERIDIAN = uf.Profile.from_corners(
    [(0, -4), (4, -4), (5, 1), (7, 1), (7, 2), (4, 2), (3, -3), (0, -3)],
    [0, 1.5, 0.8, 0.3, 0.3, 0.5, 1, 0],
    closed=False,
)
SECTION = uf.Profile.from_corners([(-5, -4), (5, -4), (5, -1), (1, 0), (1, 5), (-5, 5)], [0.5, 0.5, 1, 1.5, 1, 1])

TOOLS: dict[str, Tool] = {
    "Plane": uf.Plane((0, 0, 0), (0.2, 0.1, 1)),
    "Cylinder": uf.Cylinder((0, 0, 0), "y", 4),
    "Sphere": uf.Sphere((0, 0, 0), 3.8),
    "Torus": uf.Torus((0, 0, 0), "y", 3.6, 1.3).moved(rotation=(0.5, 0, 0.3)),
    "Box": uf.Box((0, 0, 0), (9, 6, 7), 1.2),
    "VDie": uf.VDie(opening=10, angle=88, shoulder_radius=1.5, bottom_radius=0.8, origin=(0, 0, 3)),
    "UDie": uf.UDie(opening=8, depth=6, shoulder_radius=2, bottom_radius=1.5, origin=(0, 0, 3)),
    "WipingDie": uf.WipingDie(radius=2, origin=(2, 0, 2)),
    "Punch": uf.Punch(tip_radius=1, angle=86, width=8, origin=(0, 0, -5)),
    "Extruded": uf.Extruded(SECTION),
    "Revolved": uf.Revolved(MERIDIAN),
    "mirrored": uf.WipingDie(radius=2, origin=(2, 0, 2)).mirrored("x"),
}


def draw_solids() -> Figure:
    """One panel a tool, cut to a box."""
    figure = Figure(figsize=(10, 7.6), layout="constrained")
    for i, (name, tool) in enumerate(TOOLS.items()):
        axes = figure.add_subplot(3, 4, i + 1, projection="3d")
        corners = tool.triangles(BOX, chord=0.02).corners
        colour = COLOURS[i % len(COLOURS)]
        axes.add_collection3d(
            Poly3DCollection(corners, facecolors=colour, edgecolors=colour, linewidths=0.2, shade=True)
        )
        axes.set(xlim=(-6, 6), ylim=(-6, 6), zlim=(-6, 6), title=name)
        axes.set_box_aspect((1, 1, 1), zoom=1.2)
        axes.view_init(24, -62)
        axes.set_axis_off()
    return figure


def fill(axes, tool, colour: str) -> None:
    """Solid of an open section, from its curve away from the void."""
    curve = tool.profile.points(0.01, 30.0)
    away = 30.0 if isinstance(tool, uf.Punch) else -30.0
    axes.fill_between(curve[:, 0], curve[:, 1], away, color=colour, alpha=0.25, linewidth=0)
    axes.plot(*curve.T, color=colour)


def length(axes, start, end, label: str) -> None:
    """Dimension line."""
    axes.annotate("", start, end, arrowprops={"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0})
    middle = 0.5 * np.add(start, end)
    axes.annotate(label, middle, textcoords="offset points", xytext=(0, 4), ha="center")


def draw_sections() -> Figure:
    """Sections of the press brake with their dimensions."""
    figure = Figure(figsize=(10, 2.4), layout="constrained")
    v, u, punch, wiping = figure.subplots(1, 4)
    die = uf.VDie(opening=10, angle=88, shoulder_radius=2, bottom_radius=1)
    fill(v, die, COLOURS[0])
    corner = die.opening / 2
    v.plot([-corner, 0, corner], [0, -corner / np.tan(np.radians(44)), 0], ":", color=INK, linewidth=0.8)
    length(v, (-corner, 0), (corner, 0), "opening")
    length(v, (-die.tangent_width / 2, 1.5), (die.tangent_width / 2, 1.5), "tangent_width")
    v.annotate("shoulder_radius", (5, -0.55), (-3.5, -7.2), arrowprops={"arrowstyle": "->", "color": INK})
    v.annotate("angle", (0, -3.4), ha="center")
    v.set(title="VDie", xlim=(-8, 8), ylim=(-8, 3))
    fill(u, uf.UDie(opening=8, depth=5, shoulder_radius=1.5, bottom_radius=1), COLOURS[2])
    length(u, (-4, -4), (4, -4), "")
    u.annotate("opening", (-3.8, -3.6))
    length(u, (2, -5), (2, 0), "")
    u.annotate("depth", (-1.4, -2))
    u.set(title="UDie", xlim=(-8, 8), ylim=(-8, 3))
    fill(punch, uf.Punch(tip_radius=1.2, angle=80, width=8), COLOURS[1])
    length(punch, (-4, 6.2), (4, 6.2), "width")
    punch.annotate("angle", (0, 3), ha="center")
    punch.annotate("tip_radius", (-0.75, 0.3), (-7.6, -1.5), arrowprops={"arrowstyle": "->", "color": INK})
    punch.set(title="Punch", xlim=(-8, 8), ylim=(-3, 8))
    fill(wiping, uf.WipingDie(radius=2.5), COLOURS[3])
    wiping.annotate("radius", (-0.7, -0.75), (1, 1.5), arrowprops={"arrowstyle": "->", "color": INK})
    wiping.set(title="WipingDie", xlim=(-8, 8), ylim=(-8, 3))
    for axes in (v, u, punch, wiping):
        axes.set_aspect("equal")
        axes.axhline(0, color=INK, linewidth=0.4)
        axes.plot(0, 0, "+", color=INK)
    return figure


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    with house_style():
        save(draw_solids(), folder / "tools.png", dpi=110)
        save(draw_sections(), folder / "press_brake.png", dpi=110)
