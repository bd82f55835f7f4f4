"""The reference of the book for bending: its fibres against the kernels on a point in plane strain."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform_book.material import fibres
from umform_book.metals import HARDENING


@pytest.mark.parametrize("name", HARDENING)
def test_a_fibre_is_a_point_in_plane_strain(name):
    """Pulled, pushed and pulled again: explicit rates against the return map of the kernels, in small steps of both."""
    corners, size = [0.01, -0.01], 2e-4
    ways = np.diff([0.0, *corners])
    path = np.concatenate(
        [a + w * np.linspace(0, 1, round(abs(w) / size) + 1)[1:] for a, w in zip([0.0, *corners], ways)]
    )
    state, stress = fibres.virgin(HARDENING[name], 1), []
    for change in np.diff(path, prepend=0.0):
        state = fibres.advance(HARDENING[name], state, np.array([change]))
        stress.append(fibres.stress(HARDENING[name], state)[0])
    asked = np.full((len(path), 6), np.nan)
    asked[:, 0], asked[:, 1] = path, 0.0
    found = mt.point_path(HARDENING[name], asked, np.zeros_like(asked))
    assert np.abs(np.array(stress)[:, 2]).max() < 1e-9 * 200
    for corner in corners:
        row = int(np.flatnonzero(np.isclose(path, corner))[-1])
        assert stress[row][0] == pytest.approx(found.stress[row, 0], rel=0.012)
        assert stress[row][1] == pytest.approx(found.stress[row, 1], rel=0.02)
