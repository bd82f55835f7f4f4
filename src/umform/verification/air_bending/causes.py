"""Causes of known deviations of this chapter."""

#: air-bend-mesh shows it.
ONE_LAYER = (
    "the straight normals of one layer do not see the stress through the thickness and the shear under the punch, by "
    "which the sheet bears a larger moment there: the hinge is too sharp, see air-bend-mesh"
)

#: air-bend-wide-sheet shows it.
LAYERS = (
    "fibre positions are straight and the stress through the thickness is one number in each layer; in one layer the "
    "two errors nearly cancel, eq. (2.32), in two or more they do not, and fade with their number"
)
