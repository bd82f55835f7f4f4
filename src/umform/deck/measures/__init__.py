"""Measures of a part that a deck asks for: each is a table of numbers, a CSV file and a picture."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from umform.deck.measures.base import MeasurePart
from umform.deck.measures.curves import DrawIn, Ears, SectionCurve, Springback
from umform.deck.measures.forces import Forces
from umform.deck.measures.maps import Distance, Gauge, Map

AnyMeasure = Annotated[
    SectionCurve | Springback | DrawIn | Ears | Distance | Gauge | Map | Forces, Field(discriminator="kind")
]

__all__ = ["AnyMeasure", "MeasurePart"]
