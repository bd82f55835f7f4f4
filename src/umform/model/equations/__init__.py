"""Residual and tangent over the unknowns of a model, and the checks of them."""
