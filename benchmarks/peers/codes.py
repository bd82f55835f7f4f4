"""The codes that are compared, where each is found, and how one would install it. Nothing is installed from here."""

from __future__ import annotations

from calculix_peer import CalculiX
from entries import Peer
from scripted import Scripted

_KRATOS = ("KratosStructuralMechanicsApplication", "KratosLinearSolversApplication")


def codes(python: str) -> dict[str, Peer]:
    """All codes by their name; packages of Python other than umform live in the environment of ``python``."""
    kratos = f"import importlib.metadata as m; print(m.version({_KRATOS[0]!r}))"
    every: list[Peer] = [
        Scripted("umform", "import umform; print(umform.__version__)", "pip install ."),
        CalculiX(),
        Scripted("felupe", "import felupe; print(felupe.__version__)", "pip install felupe", python),
        Scripted("Kratos", kratos, f"pip install {' '.join(_KRATOS)}", python),
    ]
    return {code.name: code for code in every}
