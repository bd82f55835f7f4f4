"""Residual and tangent of a sheet with each metal beside J2, all points flowing: ratios within one run.

    PYTHONPATH=src python benchmarks/metals.py

Laws are taken in turn, so that all see the same machine; each has its best time of processor.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import umform as uf

ELASTIC = {"E": 70e3, "nu": 0.33}
SWIFT = uf.Swift(strength=450.0, offset=0.006, exponent=0.23)
VOCE = uf.Voce(130.0, 300.0, 12.0)
HILL = uf.Hill48(r0=0.8, r45=0.5, r90=0.6)
#: AA2090-T3, Barlat et al. (2005), table 2.
YLD2004 = uf.Yld2004(
    uf.Transformation(-0.069888, 0.936408, 0.079143, 1.003060, 0.524741, 1.363180, 0.954322, 1.023770, 1.069060),
    uf.Transformation(0.981171, 0.476741, 0.575316, 0.866827, 1.145010, -0.079294, 1.404620, 1.051660, 1.147100),
)
TWO = uf.Chaboche([(4000.0, 60.0), (800.0, 8.0)])
RATE = uf.CowperSymonds(reference=6500.0, exponent=4.0)
SPCC = uf.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
FALLING = uf.FallingModulus(saturated=60e3, rate=30.0)
LAWS = {
    "J2 + Swift": uf.J2(**ELASTIC, hardening=SWIFT),
    "J2 + Voce": uf.J2(**ELASTIC, hardening=VOCE),
    "Mises + Voce": uf.Metal(**ELASTIC, hardening=VOCE),
    "Hill48 + Swift": uf.Metal(**ELASTIC, hardening=SWIFT, yield_function=HILL),
    "Hill48 + Chaboche(2)": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=HILL, back_stress=TWO),
    "Hill48 + falling E": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=HILL, modulus=FALLING),
    "Hill48 + rate": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=HILL, rate=RATE),
    "Hill48 + two surfaces": uf.Metal(**ELASTIC, hardening=uf.Perfect(124.0), yield_function=HILL, back_stress=SPCC),
    "Yld2004 + Voce": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=YLD2004),
    "Yld2004 + Chaboche(2)": uf.Metal(**ELASTIC, hardening=VOCE, yield_function=YLD2004, back_stress=TWO),
}


def flowing(law: uf.Metal | uf.J2, cells: int, strain: float) -> tuple[uf.Model, np.ndarray]:
    """A sheet that is bent and stretched by ``strain`` at least, from the virgin state."""
    mesh = uf.mesh.strip(length=10.0, width=10.0, thickness=1.0, cells=(cells, cells), cell="hex8")
    x, y, z = mesh.points.T
    u = np.stack([strain * x * (1 + 0.1 * z), -0.4 * strain * y + 0.2 * strain * x, -0.6 * strain * z], axis=1)
    model = uf.Model(mesh, "ANS3DEAS", material=law, rolling=(1, 0, 0), thickness_order=1, thickness_points=5)
    model.fix("x0")
    model.system.time = 0.01  # for the law with a rate
    return model, u.ravel()


def main() -> None:
    """Print microseconds an element and the ratio to J2 with the same hardening curve."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=24, help="elements along a side")
    parser.add_argument("--repeat", type=int, default=15)
    parser.add_argument("--strain", type=float, nargs="+", default=[0.005, 0.02, 0.1])
    arguments = parser.parse_args()
    uf.set_threads(1)
    for strain in arguments.strain:
        sheets = {name: flowing(law, arguments.cells, strain) for name, law in LAWS.items()}
        best = dict.fromkeys(sheets, np.inf)
        for _ in range(arguments.repeat):
            for name, (model, u) in sheets.items():
                start = time.process_time()
                assert model.evaluate(u).failed < 0
                best[name] = min(best[name], time.process_time() - start)
        print(f"strain {strain}\n{'law':<24}{'us':>8}{'to J2':>8}")
        for name, seconds in best.items():
            beside = "J2 + Swift" if "Swift" in name else "J2 + Voce"
            print(f"{name:<24}{1e6 * seconds / arguments.cells**2:>8.2f}{seconds / best[beside]:>8.2f}")


if __name__ == "__main__":
    main()
