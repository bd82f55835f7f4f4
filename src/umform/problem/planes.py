"""Check that the nodes of a plane of symmetry lie in a plane."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from umform.model import Model
from umform.model.contact.encounter import sheet_thickness
from umform.problem.contents import Contents
from umform.problem.findings import Finding, warning
from umform.problem.selection import nodes_of
from umform.problem.supports import Symmetry

#: Distance in thicknesses that a node may have from the plane.
_FLAT = 0.05


def planes(contents: Contents, model: Model) -> Iterator[Finding]:
    """Warn of a symmetry whose nodes do not lie in a plane: probably another edge of the blank is meant."""
    for k, support in enumerate(contents.supports):
        if not isinstance(support, Symmetry):
            continue
        places = model.mesh.points[nodes_of(model.mesh, support.nodes), "xyz".index(support.normal)]
        if len(places) and np.ptp(places) > _FLAT * sheet_thickness(model.mesh):
            yield warning(
                f"support {k + 1}",
                f"the nodes of the symmetry with the normal {support.normal} lie between {support.normal} = "
                f"{places.min():.4g} and {places.max():.4g}, in no plane",
                "another edge: those of an outline count its lines and arcs, also the arcs of its radii",
            )
