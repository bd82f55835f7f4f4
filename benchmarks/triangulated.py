"""What a die of triangles costs beside the elements: one evaluation of a sheet that lies on it with every point.

    python benchmarks/triangulated.py

prints the CPU time of the elements, and that of contact with a plane and with a die of triangles as ratios to it.
"""

from __future__ import annotations

import time

import numpy as np

import umform as uf
from umform.surfaces import Triangles

SIDE, CELLS, GRID, ROUNDS = 100.0, 60, 100, 15
THROUGH = 5  # points through the thickness
SLIDE = 0.1  # between two evaluations


def die() -> uf.Triangulated:
    """20 000 triangles of a wavy die face of the size of the sheet and more."""
    line = np.linspace(-10.0, SIDE + 10.0, GRID + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    points = np.stack([x, y, np.sin(x / 12.0) * np.cos(y / 15.0)], axis=-1).reshape(-1, 3)
    at = np.arange(len(points)).reshape(x.shape)
    a, b, c, d = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel(), at[:-1, 1:].ravel()
    return uf.Triangulated(Triangles(points, np.vstack([np.c_[a, b, c], np.c_[a, c, d]])), open=True)


def lying(tool: uf.surfaces.Tool | None, points: int) -> uf.Model:
    """A sheet that lies on a tool with all its points."""
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(strength=500.0, offset=0.01, exponent=0.2))
    flat = uf.mesh.strip(SIDE, SIDE, 1.0, (CELLS, CELLS))
    bent = flat.transformed(lambda x: x + _raised(x))
    model = uf.Model(bent, "ANS3DEAS", material=steel, thickness_points=THROUGH)
    if tool is not None:
        model.contact("lower", tool, penalty=100.0, points=points, name="die")
    return model


def seconds(models: dict[str, uf.Model]) -> dict[str, float]:
    """CPU time of one evaluation of residual and tangent of each: the least of some rounds, in which all take turns.

    The sheet slides to and fro on the die from round to round.
    """
    best = dict.fromkeys(models, np.inf)
    for number in range(ROUNDS):
        for name, model in models.items():
            x = model.system.x.copy()
            x[: model.mesh.points.size : 3] += SLIDE * (number % 2)
            start = time.process_time()
            model.evaluate(x)
            best[name] = min(best[name], time.process_time() - start)
    return best


def _raised(x: np.ndarray) -> np.ndarray:
    """Onto the die, 0.01 deep."""
    z = np.sin(x[:, 0] / 12.0) * np.cos(x[:, 1] / 15.0) + 0.5 - 0.01
    return np.c_[np.zeros((len(x), 2)), z]


def main() -> None:
    """Print one row a kind of tool."""
    tools = {"plane": uf.Plane((0, 0, 2.0)), "20 000 triangles": die()}
    models = {"elements": lying(None, 1)}
    for points in (2, 3):
        models |= {f"{points} x {points} points, {name}": lying(tool, points) for name, tool in tools.items()}
    found = seconds(models)
    elements = found.pop("elements")
    print(f"elements: {1e6 * elements / CELLS**2:.1f} us of CPU each, {CELLS**2} of them")
    for name, both in found.items():
        print(f"contact with {name}: {(both - elements) / elements:.2f} of the elements")


if __name__ == "__main__":
    main()
