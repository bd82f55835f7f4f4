"""Free bending of a strip over a cylinder: parameters, one case, what is measured, all cases, figure, report."""
