"""A UMAT compared with the same metal of umform: one bent strip, two laws.

    python examples/umat/compare.py

Compiles ``kinematic.c``, or ``kinematic.f90`` where there is no C compiler, and bends a strip with both.
"""

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

import umform as uf

E, NU, YIELD, ISOTROPIC, KINEMATIC = 210e3, 0.3, 200.0, 500.0, 3000.0


def compiled(folder):
    """Shared library of the UMAT."""
    compiler, source = ("gcc", "kinematic.c") if shutil.which("gcc") else ("gfortran", "kinematic.f90")
    library, path = Path(folder) / "kinematic.so", Path(__file__).with_name(source)
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-o", library, path, "-lm"], check=True)
    return library


def bent(law):
    """Force of a cantilever that is bent and taken back, and its deepest plastic strain."""
    strip = uf.mesh.strip(length=20, width=4, thickness=1, cells=(10, 1))
    model = uf.Model(strip, "ANS3DEAS", material=law)
    model.fix("x0")
    tip = model.prescribe("x1", "z", "tip")
    result = uf.solve(model, [uf.Move(tip, to=4.0, steps=10), uf.Move(tip, to=1.0, steps=10)], progress=False)
    return model, result


with tempfile.TemporaryDirectory() as folder:
    umat = uf.Umat(
        compiled(folder),
        state={"back_stress": 6, "eqps": 1},
        properties=[E, NU, YIELD, ISOTROPIC, KINEMATIC],
        energies=True,
        directional=False,
    )
    metal = uf.Metal(E, NU, hardening=uf.Linear(YIELD, ISOTROPIC), back_stress=uf.Chaboche([(KINEMATIC, 0.0)]))
    (model, foreign), (_, own) = bent(umat), bent(metal)

difference = np.abs(foreign["tip_force"] - own["tip_force"]).max() / np.abs(own["tip_force"]).max()
eqps = uf.fields.point_fields(model).eqps.max()
print(f"forces differ by {difference:.1e} of the largest; plastic strain up to {eqps:.3f}")
print(f"iterations {foreign['iterations'].sum():.0f} and {own['iterations'].sum():.0f}")
print(f"balance closes to {np.abs(foreign.balance().drift).max():.1e} and {np.abs(own.balance().drift).max():.1e}")
assert difference < 1e-9
