"""The codes that are compared, where each is found, and how one would install it. Nothing is installed from here."""

from __future__ import annotations

import sys
from collections.abc import Mapping

from calculix_peer import CalculiX
from entries import Peer
from scripted import Scripted

_KRATOS = ("KratosStructuralMechanicsApplication", "KratosLinearSolversApplication")
_VERSION_OF_KRATOS = f"import importlib.metadata as m; print(m.version({_KRATOS[0]!r}))"
#: Only the files that it writes tell.
_VERSION_OF_GETFEM = """
import getfem, pathlib, tempfile
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / "mesh"
    getfem.Mesh("empty", 1).save(str(path))
    print(path.read_text().split("VERSION")[1].split()[0])
"""


def codes(pythons: Mapping[str, str]) -> dict[str, Peer]:
    """All codes by their name.

    Parameters
    ----------
    pythons : mapping
        By name of a code the interpreter that has its package; default: this one.
    """

    def python(name: str) -> str:
        return pythons.get(name, sys.executable)

    every: list[Peer] = [
        Scripted("umform", "import umform; print(umform.__version__)", "pip install ."),
        CalculiX(),
        Scripted("felupe", "import felupe; print(felupe.__version__)", "pip install felupe", python("felupe")),
        Scripted("GetFEM", _VERSION_OF_GETFEM, "apt install python3-getfem", python("GetFEM")),
        Scripted("Kratos", _VERSION_OF_KRATOS, f"pip install {' '.join(_KRATOS)}", python("Kratos")),
    ]
    return {code.name: code for code in every}
