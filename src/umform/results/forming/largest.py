"""Largest thinning and strains of a part, and its margin to the forming limits, as numbers to report."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from umform.results.quantity import Quantity

#: Names of the numbers.
THINNING, MARGIN = "largest thinning", "margin to the forming limit"
BY_STRAINS, BY_PATHS = "forming limit used, by strains", "forming limit used, by paths"


def extremes(fields: Mapping[str, NDArray[np.float64]]) -> list[Quantity]:
    """The numbers of a part.

    Parameters
    ----------
    fields : mapping of str to ndarray
        Of :func:`umform.results.forming.forming_fields`, and of :attr:`umform.results.forming.PathFields.fields`.
    """
    found = [
        Quantity(THINNING, "%", value=float(fields["thinning"].max()), leading=True),
        Quantity("largest thickening", "%", value=float(-fields["thinning"].min())),
        Quantity("largest major strain", value=float(fields["major_middle"].max())),
    ]
    if "limit_margin" in fields:
        least = float(fields["limit_margin"].min())
        found.append(Quantity(MARGIN, value=least, limit=0.0, at_least=True, leading=True))
    if "path_use" in fields:
        shares = {BY_STRAINS: fields["strain_use"], BY_PATHS: fields["path_use"]}
        found += [Quantity(name, "%", value=100.0 * float(share.max())) for name, share in shares.items()]
    return found
