"""Detect faces that a tool and another sheet press at once: the tool lies inside of that sheet."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids
from umform.model import Model
from umform.model.contact.sheets import SheetContact
from umform.results.history import History
from umform.surfaces.directions import coordinates

#: Number that makes a cell and a face of it one key.
_FACES = 8


def warn_of_shared_faces(model: Model, result: History, found: Mapping[Any, Any]) -> None:
    """Name each tool that holds faces at all their points which another sheet holds as well."""
    for sheets in model.system.penalised:
        if not isinstance(sheets, SheetContact):
            continue
        for faces, side in zip(sheets.sides, found[sheets].sides, strict=True):
            covered = _covered(faces, side.active)
            for pair in model.contacts:
                both = np.isin(_keys(faces), _keys(pair.faces[_covered(pair.faces, found[pair].active)]))
                shared = np.flatnonzero(covered & both)
                if not shared.size:
                    continue
                x = side.x.reshape(len(faces), -1, 3)[shared[0]].mean(axis=0) + 0.0
                text = (
                    f"contact {pair.name} and contact {sheets.name} press {len(shared)} faces at once, one near "
                    f"{coordinates(x)}: the tool lies inside of the other sheet; give the "
                    "tool a contact with the outer face of that sheet"
                )
                if text not in result.warnings:
                    result.warn(text)


def _covered(faces: Ids, active: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Faces that are held at all their points."""
    return np.asarray(active.reshape(len(faces), -1).all(axis=1)) if len(faces) else np.zeros(0, dtype=bool)


def _keys(faces: Ids) -> Ids:
    return np.asarray(_FACES * faces[:, 0].astype(np.int64) + faces[:, 1])
