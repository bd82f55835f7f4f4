"""The laws that a deck can name."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Annotated

from umform.materials.compiled import CompiledLaw
from umform.materials.elastic import Elastic
from umform.materials.known import known
from umform.materials.material import Material
from umform.materials.umat import Umat
from umform.spec import OneOf


def laws() -> dict[str, type]:
    """The laws by the word ``law`` of a deck: all with elastic constants, and those of shared libraries."""
    own = {name: kind for name, kind in known(Elastic).items() if hasattr(kind, "law")}
    return own | {"UMAT": Umat, "Compiled": CompiledLaw}


def full_text(law: object) -> str:
    """A law with all of its numbers, for records; its repr leaves out those of a long table."""
    if not is_dataclass(law) or isinstance(law, type):
        return repr(law)
    shown = (f"{one.name}={full_text(getattr(law, one.name))}" for one in fields(law) if one.repr)
    return f"{type(law).__name__}({', '.join(shown)})"


#: One of the laws; the word ``law`` of a deck names it.
Law = Annotated[Material, OneOf("law", laws)]
