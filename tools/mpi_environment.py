"""Make .venv-mpi, the environment that runs umform on many ranks with Debian's PETSc; ``make mpi`` calls it.

It holds the umform that is installed in .venv, Debian's petsc4py and mpi4py by links, the packages that umform needs
from PyPI, and NumPy 1: Debian's petsc4py is built with it. docs/parallel.md has the other way, PETSc from PyPI.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from requirements import requirements

PACKAGES = ("openmpi-bin", "python3-petsc4py", "python3-mpi4py", "libopenblas0-serial")
#: Where Debian and Ubuntu put petsc4py (one folder for each release of PETSc) and mpi4py.
PETSC4PY = "usr/lib/petscdir/*/*-real/lib/python3/dist-packages/petsc4py"
MPI4PY = "usr/lib/python3/dist-packages/mpi4py"
TESTS = ("pytest", "pytest-timeout")
OTHERWISE = "or follow docs/parallel.md, which builds PETSc from PyPI"


def debian(pattern: str) -> Path | None:
    """The newest folder of Debian that fits a pattern."""
    return max(Path("/").glob(pattern), default=None)


def present() -> bool:
    """Whether all that Debian gives is there."""
    return None not in (debian(PETSC4PY), debian(MPI4PY), shutil.which("mpiexec"))


def install() -> None:
    """Let apt-get install what is missing; say what to do where it cannot."""
    if present():
        return
    packages = " ".join(PACKAGES)
    if shutil.which("apt-get") is None:
        sys.exit(f"umform on many ranks needs the packages {packages} of Debian or Ubuntu; {OTHERWISE}")
    if os.geteuid() != 0:
        sys.exit(f"umform on many ranks needs PETSc: sudo apt-get install {packages}\n{OTHERWISE}")
    quiet = {"env": {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}, "stdout": subprocess.DEVNULL}
    subprocess.run(["apt-get", "-q", "update"], check=True, **quiet)
    subprocess.run(["apt-get", "-q", "install", "-y", "--no-install-recommends", *PACKAGES], check=True, **quiet)
    if not present():
        sys.exit(f"the packages {packages} hold no petsc4py where it was looked for, /{PETSC4PY}; {OTHERWISE}")


def check_python(petsc4py: Path) -> None:
    """Refuse a Python that Debian's petsc4py is not built for."""
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    built = [file.name for file in petsc4py.rglob("PETSc.*.so")]
    if f"PETSc{suffix}" not in built:
        sys.exit(
            f"Debian's petsc4py is {', '.join(built)}, and this Python wants {suffix}.\n"
            f"Take Debian's Python: make clean; make PYTHON=/usr/bin/python3 test-mpi; {OTHERWISE}"
        )


def make(folder: Path, umform: Path) -> None:
    """Make the environment: packages from PyPI, then links to umform and to Debian's two packages."""
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    pip = [folder / "bin" / "python", "-m", "pip", "--disable-pip-version-check", "-q", "install"]
    tests = [line for line in requirements("dev") if line.split(">")[0] in TESTS]
    subprocess.run([*pip, *requirements("run"), *tests, "numpy<2"], check=True)
    site = Path(sysconfig.get_path("purelib", vars={"base": str(folder), "platbase": str(folder)}))
    for target in (umform, debian(PETSC4PY), debian(MPI4PY)):
        assert target is not None
        link = site / target.name
        link.unlink(missing_ok=True)
        link.symlink_to(target.resolve())
    command = folder / "bin" / "umform"
    command.write_text(f"#!{folder / 'bin' / 'python'}\nfrom umform.cli import main\n\nmain()\n")
    command.chmod(0o755)


if __name__ == "__main__":
    install()
    found = debian(PETSC4PY)
    assert found is not None
    check_python(found)
    make(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
