"""Usual types of parameters: bounds, units and likely mistakes."""

from __future__ import annotations

from typing import Annotated, Any

from annotated_types import Ge, Gt, Le, Lt, MinLen

from umform.spec.parameter import About

_MISSING = "a sign, or a missing value"

#: Default of a parameter that follows from others.
FOLLOWS: Any = None

#: Largest coordinate: volumes and their squares stay finite.
FARTHEST = 1e50

#: A length in mm.
Length = Annotated[float, Gt(0.0), About("mm", cause=_MISSING)]
#: A length of a sheet or of tools in mm, not of a gap.
Size = Annotated[float, Ge(1e-3), Le(1e5), About("mm", cause="another unit, or a sign")]
#: A stress in MPa.
Stress = Annotated[float, Gt(0.0), About("MPa", cause=_MISSING)]
#: A force in N.
Force = Annotated[float, Gt(0.0), About("N", cause=_MISSING)]
#: A contact pressure per penetration.
Penalty = Annotated[float, Gt(0.0), About("MPa/mm", cause=_MISSING)]
#: Another positive number.
Positive = Annotated[float, Gt(0.0), About(cause=_MISSING)]
#: A number that may be zero.
NotNegative = Annotated[float, Ge(0.0), About(cause="a sign, nan or inf", remedy="zero or more")]
#: A text that is not empty.
Text = Annotated[str, MinLen(1)]
#: An angle between two straight lines.
Degrees = Annotated[
    float, Gt(0.0), Lt(180.0), About("degrees", cause="radians, a sign, or the angle of bending instead")
]
#: An angle that an element turns over the radius of a tool.
ElementTurn = Annotated[float, Gt(0.0), Le(90.0), About(cause="radians, or a sign", remedy="15 degrees are usual")]
#: An angle from which an edge is sharp.
Sharp = Annotated[float, Gt(0.0), Lt(90.0), About("degrees", cause="radians, or the angle in the solid")]
#: A part of a whole.
Share = Annotated[float, Gt(0.0), Le(1.0), About(cause="a percentage, or a sign")]
#: A number of things.
Count = Annotated[int, Ge(1), About(cause="a fraction, or a sign")]
#: Number of increments of a step.
Increments = Annotated[int, Ge(1), Le(1_000_000), About(cause="a fraction, or a sign", remedy="a whole number, 50")]
#: Number of states of a run that are kept.
Frames = Annotated[int, Ge(0), About(cause="a part of the states, or a sign", remedy="60; 0 keeps none")]
#: How often an increment may be halved.
Cuts = Annotated[int, Ge(0), Le(40), About(cause="a fraction, or a sign")]
#: Ratio of the largest increment to the first one.
Growth = Annotated[float, Ge(1.0), About(cause="a ratio below 1", remedy="1 never exceeds the first increment")]
#: Duration of a step.
Duration = Annotated[
    float,
    Gt(0.0),
    About(cause="a sign, or the time at the end in place of what the step takes"),
]
#: The rolling direction of a sheet that is bent about one line.
Rolling = Annotated[
    float,
    Ge(-180.0),
    Le(180.0),
    About("degrees", cause="a vector in place of an angle", remedy="0 along the bend line, 90 across it"),
]
#: Contact points per direction of a facet.
ContactPoints = Annotated[int, Ge(1), Le(10), About(cause="all points of a facet instead of those of one direction")]
#: A coefficient of friction.
Friction = Annotated[
    float, Ge(0.0), Le(2.0), About(cause="a sign, or a percentage", remedy="0.05 to 0.2 for lubricated sheet")
]
