"""An S-shaped rail drawn between tools from STL files, under a holder.

    python examples/s_rail.py [FOLDER]

writes die and punch as STL, prints how they were read, and draws a coarse blank by 6 mm.
"""

import sys
from pathlib import Path

import meshio
import numpy as np

import umform as uf

#: Rail: length, sway of its middle line, half width of the die, clearance, radius of all edges; mm.
LENGTH, SWAY, HALF, CLEARANCE, RADIUS = 200.0, 25.0, 37.5, 1.058, 5.0
#: Sheet: thickness and half width; force on the holder in N; friction.
THICKNESS, BLANK, HOLDER, FRICTION = 0.92, 85.0, 60e3, 0.11
STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength=567.0, offset=0.0071, exponent=0.264))
_DIE = [(HALF + 20, 0), (HALF, 0), (HALF, -60), (-HALF, -60), (-HALF, 0), (-HALF - 20, 0)]
_NOSE = [(CLEARANCE - HALF, 60), (CLEARANCE - HALF, 0), (HALF - CLEARANCE, 0), (HALF - CLEARANCE, 60)]
SECTIONS = {
    "die": uf.Profile.from_corners(_DIE, [0, RADIUS, 3, 3, RADIUS, 0], closed=False),
    "punch": uf.Profile.from_corners(_NOSE, [0, RADIUS, RADIUS, 0], closed=False),
}


def write(section: uf.Profile, path: Path, chord: float = 0.05, along: int = 80) -> Path:
    """Lead a section along the middle line, from before the rail to behind it, and write the triangles."""
    curve = section.points(chord, beyond=60.0)
    t = np.linspace(-0.1, 1.1, along + 1)
    middle = np.c_[LENGTH * t, SWAY * np.cos(np.pi * t)]
    slope = np.c_[np.full(t.shape, LENGTH), -SWAY * np.pi * np.sin(np.pi * t)]
    left = np.c_[-slope[:, 1], slope[:, 0]] / np.hypot(*slope.T)[:, None]
    points = np.empty((len(t), len(curve), 3))
    points[..., :2] = middle[:, None] + curve[None, :, :1] * left[:, None]
    points[..., 2] = curve[None, :, 1]
    at = np.arange(points[..., 0].size).reshape(points.shape[:2])
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    triangles = np.vstack([np.c_[a, b, c], np.c_[a, c, d]])
    meshio.write(path, meshio.Mesh(points.reshape(-1, 3), [("triangle", triangles)]), binary=True)
    return path


def blank(turn: float, along: int) -> uf.Mesh:
    """A blank whose lines follow the rail, finer where metal goes over the radii; its outer edges are straight."""
    over = uf.mesh.Bent(HALF - 6.5, 2.0 * HALF, RADIUS + 0.5 * THICKNESS, "the edges of die and punch")
    sizes = uf.mesh.bending_sizes(0.0, BLANK, [over], turn=turn, largest=10.0)
    print(f"across half of the blank: {sizes}")
    lines = np.r_[-sizes.ends[:0:-1], sizes.ends]
    flat = uf.mesh.grid(np.linspace(0.0, LENGTH, along + 1), lines, [0.0, THICKNESS])

    def along_the_rail(x: np.ndarray) -> np.ndarray:
        share = np.clip((BLANK - np.abs(x[:, 1])) / 35.0, 0.0, 1.0)
        return np.c_[x[:, 0], x[:, 1] + share * SWAY * np.cos(np.pi * x[:, 0] / LENGTH), x[:, 2]]

    return flat.transformed(along_the_rail)


def draw(tools: dict[str, uf.Triangulated], depth: float, turn: float = 30.0, along: int = 12) -> uf.Result:
    """Close the holder and draw; only the holder and friction hold the blank."""
    model = uf.Model(blank(turn, along), "ANS3DEAS", material=STEEL, thickness_points=5)
    touch = {"penalty": 2e3, "points": 2, "friction": FRICTION}
    model.contact("lower", tools["die"], name="die", **touch)
    holder = model.contact("upper", uf.Plane((0, 0, THICKNESS), normal="-z"), name="holder", **touch)
    punch = model.contact("upper", tools["punch"].moved((0, 0, THICKNESS)), name="punch", **touch)
    hold, way = model.press(holder, "-z", name="hold"), model.drive(punch, "-z", name="stroke")
    return uf.solve(model, [uf.Close(hold, HOLDER), uf.Move(way, depth, steps=max(round(2 * depth), 1))])


def main() -> None:
    """Write, read, draw."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    tools = {}
    for name, section in SECTIONS.items():
        tools[name] = uf.Triangulated.from_stl(write(section, folder / f"s_rail_{name}.stl"), open=True)
        print(tools[name])
    result = draw(tools, 6.0)
    force = result["stroke_force"][-1] / 1e3
    print(f"force of the punch at {result['stroke'][-1]:.4g} mm: {force:.3g} kN")


if __name__ == "__main__":
    main()
