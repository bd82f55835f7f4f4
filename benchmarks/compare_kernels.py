"""Largest relative difference between the answers of two builds of the kernels, on distorted elements in random states.

``python benchmarks/compare_kernels.py OLD.so NEW.so`` takes two files ``_core*.so`` of builds with the same bindings.
Each element and law answers at three sizes of the displacement: residual and tangent, then after a recovery and a
commit the enhanced parameters, the history, fields and energies.
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np


def answers(core: str) -> dict[str, np.ndarray]:
    """All answers of the kernels in the file ``core``, by name."""
    specification = importlib.util.spec_from_file_location("umform._core", core)
    assert specification is not None and specification.loader is not None
    sys.modules["umform._core"] = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(sys.modules["umform._core"])
    import umform as uf
    from umform import elements
    from umform.model import Model

    steel = {"E": 210e3, "nu": 0.3}
    curves = (uf.Linear(yield_stress=160.0, modulus=500.0), uf.LinearVoce(160.0, 100.0, 320.0, 15.0))
    laws = [uf.SVK(**steel), uf.NeoHooke(**steel), uf.NeoHookePower(**steel)]
    laws += [uf.J2(**steel, hardening=curve) for curve in (*curves, uf.Swift(500.0, 0.004, 0.21))]
    rng = np.random.default_rng(1)
    results: dict[str, np.ndarray] = {}
    for name in elements.CATALOGUE:
        mesh = uf.mesh.strip(length=10.0, width=8.0, thickness=1.0, cells=(3, 3), cell=elements.element(name).cell)
        mesh.points[:] += 0.1 * rng.normal(size=mesh.points.shape)
        displacements = [scale * rng.normal(size=mesh.points.size) for scale in (3e-4, 1e-2, 5e-2)]
        for number, law in enumerate(laws):
            model = Model(mesh, name, material=law)
            model.fix("x0")
            for size, u in enumerate(displacements):
                case = f"{name} {number} {size}"
                evaluation = model.evaluate(u, u)
                results[f"residual {case}"], results[f"tangent {case}"] = evaluation.residual, evaluation.values
                results[f"failed {case}"] = np.array([float(evaluation.failed)])
                if evaluation.failed >= 0:
                    break
                model.system.recover(0.007 * u)
                model.system.commit(evaluation)
                results[f"alpha {case}"], results[f"history {case}"] = (
                    model.bodies.only.block.alpha,
                    model.bodies.only.block.state,
                )
                try:
                    fields = model.bodies.only.block.point_fields(u)
                except ValueError:  # the recovery has led out of the domain of the law
                    break
                results |= {f"{what} {case}": field for what, field in zip(("E", "S", "frame", "F", "dV"), fields)}
                results[f"energies {case}"] = np.array(model.bodies.only.block.energy(u))
    return results


def main() -> None:
    """Compare two files, or store the answers of one."""
    if sys.argv[1] == "--store":
        np.savez(sys.argv[3], **answers(sys.argv[2]))
        return
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / f"{k}.npz" for k in range(2)]
        for core, file in zip(sys.argv[1:3], files, strict=True):
            subprocess.run([sys.executable, __file__, "--store", core, str(file)], check=True)
        old, new = (dict(np.load(file)) for file in files)
    if old.keys() != new.keys():
        raise SystemExit(f"other answers: {sorted(old.keys() ^ new.keys())[:5]}")
    worst: dict[str, tuple[float, str]] = {}
    for name, values in old.items():
        what, case = name.split(" ", 1)
        scale = float(np.abs(values).max(initial=0.0)) or 1.0
        worst[what] = max(
            worst.get(what, (0.0, "")), (float(np.abs(new[name] - values).max(initial=0.0)) / scale, case)
        )
    for what, (difference, case) in worst.items():
        print(f"{what:<10}{difference:10.1e}   {case}")


if __name__ == "__main__":
    main()
