"""Newton's iterations of runs with each metal beside J2, and the drift of the balance of energy.

    PYTHONPATH=src python benchmarks/metal_iterations.py    # half a minute

A strip that is bent and bent back, one that is pulled at 30 degrees to the rolling direction, one that is bent over a
cylinder and released: ratios of all iterations to those of J2 with the same curve and increments, and the largest
drift over all runs.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

import umform as uf
from metals import ELASTIC, FALLING, HILL, SPCC, SWIFT, TWO, VOCE, YLD2004

RATE = uf.CowperSymonds(reference=6500.0, exponent=4.0)
LAWS = {
    "Mises + Voce": uf.Metal(**ELASTIC, hardening=VOCE),
    "Hill48 + Swift": uf.Metal(**ELASTIC, hardening=SWIFT, yield_function=HILL),
    "Hill48 + Chaboche(2)": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=HILL, back_stress=TWO),
    "Hill48 + falling E": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=HILL, modulus=FALLING),
    "Hill48 + rate": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=HILL, rate=RATE),
    "Hill48 + two surfaces": uf.Metal(**ELASTIC, hardening=uf.Perfect(124.0), yield_function=HILL, back_stress=SPCC),
    "Hosford(20) + Voce": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=uf.Hosford(20)),
    "Yld2004 + Voce": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=YLD2004),
    "Yld2004 + Chaboche(2)": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=YLD2004, back_stress=TWO),
}


def strip(law: uf.Metal | uf.J2, length: float, cells: tuple[int, int]) -> uf.Model:
    """A strip clamped at one end, its rolling direction at 30 degrees to the length."""
    mesh = uf.mesh.strip(length=length, width=4.0, thickness=1.0, cells=cells)
    rolling = (math.cos(math.pi / 6), math.sin(math.pi / 6), 0.0)
    model = uf.Model(mesh, "ANS3DEAS", material=law, rolling=rolling)
    model.fix("x0")
    return model


def bent(law: uf.Metal | uf.J2) -> uf.Result:
    """Bent, bent back, and bent again."""
    model = strip(law, 20.0, (10, 2))
    tip = model.prescribe("x1", "z", "tip")
    ways = [uf.Move(tip, to=to, steps=12, time=0.1) for to in (4.0, -2.0, 2.0)]
    return uf.solve(model, ways, progress=False, frames=0)


def pulled(law: uf.Metal | uf.J2) -> uf.Result:
    """Pulled by a tenth and pushed back a little."""
    model = strip(law, 12.0, (6, 2))
    pull = model.prescribe("x1", "x", "pull")
    ways = [uf.Move(pull, to=to, steps=12, time=0.1) for to in (1.2, 0.9)]
    return uf.solve(model, ways, progress=False, frames=0)


def over_a_cylinder(law: uf.Metal | uf.J2) -> uf.Result:
    """Pressed on a cylinder and released."""
    mesh = uf.mesh.strip(length=30.0, width=4.0, thickness=1.0, cells=(16, 1))
    model = uf.Model(mesh, "ANS3DEAS", material=law, rolling=(1, 0, 0))
    model.symmetry("x0", normal="x")
    model.fix([0], "y")
    punch = model.prescribe("x0_lower", "z", "punch")
    model.contact("lower", uf.Cylinder(centre=(12, 0, -10.5), axis="y", radius=10), penalty=100, points=5, name="tool")
    steps = [uf.Move(punch, to=-6.0, steps=40, time=0.5), uf.Release(punch)]
    return uf.solve(model, steps, progress=False, frames=0)


RUNS: dict[str, Callable[[uf.Metal | uf.J2], uf.Result]] = {"bent": bent, "pulled": pulled, "cylinder": over_a_cylinder}


def main() -> None:
    """Print iterations of each run over those of J2, the median over the runs, and the largest drift."""
    uf.set_threads(1)
    twins = {"Voce": uf.J2(**ELASTIC, hardening=VOCE), "Swift": uf.J2(**ELASTIC, hardening=SWIFT)}
    plain = {name: {run: solve(law) for run, solve in RUNS.items()} for name, law in twins.items()}
    print(f"{'law':<24}" + "".join(f"{run:>10}" for run in RUNS) + f"{'median':>10}{'drift':>10}{'of J2':>10}")
    for name, law in LAWS.items():
        beside = plain["Swift" if "Swift" in name else "Voce"]
        ratios, drift, its = [], 0.0, 0.0
        for run, solve in RUNS.items():
            result = solve(law)
            ratios.append(result["iterations"].sum() / beside[run]["iterations"].sum())
            drift = max(drift, np.abs(result.balance().drift).max())
            its = max(its, np.abs(beside[run].balance().drift).max())
        columns = "".join(f"{ratio:>10.2f}" for ratio in ratios)
        print(f"{name:<24}{columns}{np.median(ratios):>10.2f}{drift:>10.1e}{its:>10.1e}", flush=True)


if __name__ == "__main__":
    main()
