"""Measures of a part that a deck asks for: each is a table of numbers, a CSV file and a picture."""

from __future__ import annotations

from typing import Annotated

from umform.problem.measures.base import MeasurePart
from umform.problem.measures.curves import DrawIn, Ears, SectionCurve, Springback
from umform.problem.measures.forces import Forces
from umform.problem.measures.legs import Angle
from umform.problem.measures.maps import Distance, Gauge, Map
from umform.problem.notes import Field

AnyMeasure = Annotated[
    SectionCurve | Springback | Angle | DrawIn | Ears | Distance | Gauge | Map | Forces, Field(discriminator="kind")
]

__all__ = ["AnyMeasure", "MeasurePart"]
