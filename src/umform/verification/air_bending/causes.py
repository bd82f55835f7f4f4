"""Causes of known deviations of this chapter."""

#: air-bend-mesh shows it.
ONE_LAYER = (
    "the straight normals of one layer do not see the stress through the thickness and the shear under the punch, by "
    "which the sheet bears a larger moment there: the hinge is too sharp, see air-bend-mesh"
)
