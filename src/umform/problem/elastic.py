"""The elastic constants of a deck."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from umform.problem.parts import Part, Positive


class Elastic(Part):
    """Elastic constants: E and nu, or kappa and mu."""

    E: Positive | None = None
    """Young's modulus."""
    nu: Annotated[float, Field(gt=-1, lt=0.5)] | None = None
    """Poisson's ratio."""
    kappa: Positive | None = None
    """Bulk modulus."""
    mu: Positive | None = None
    """Shear modulus."""

    @model_validator(mode="after")
    def _is_one_pair(self) -> Elastic:
        given = {name for name in ("E", "nu", "kappa", "mu") if getattr(self, name) is not None}
        if given not in ({"E", "nu"}, {"kappa", "mu"}):
            raise PydanticCustomError("constants", "give E and nu, or kappa and mu, and no others")
        return self

    def constants(self) -> dict[str, Any]:
        """The given constants."""
        return self.model_dump(include={"E", "nu", "kappa", "mu"}, exclude_none=True)
