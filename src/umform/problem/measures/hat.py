"""Halves of a hat section, and their angles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.report.symmetry import Mirror
from umform.results.forming import Section, UBendAngles, u_bend_angles

Floats = NDArray[np.float64]

#: Angles in degrees beyond which a wall or a flange is none: a hat has about 90.
_BENT = (30.0, 150.0)
#: The flange is measured over so many parts of the points of a half.
_FLANGE = 12


@dataclass(frozen=True)
class Half:
    """Half of a hat section from the middle of its bottom to the end of its flange.

    Attributes
    ----------
    side : str
        Which one of a whole section, as the end of a name; empty if only one half is computed.
    line : ndarray, shape (n, 2)
        Mid-surface: way from the middle, height above the bottom.
    origin, signs : ndarray, shape (2,)
        Of the line in the picture of the section.
    """

    side: str
    line: Floats
    origin: Floats
    signs: Floats

    @classmethod
    def of(cls, side: str, line: Floats, sign: float) -> Half:
        """From way and z in the section, which begin in the middle of the bottom."""
        origin = line[0].copy()
        away = line - origin
        upright = -1.0 if -away[:, 1].min() > away[:, 1].max() else 1.0
        signs = np.array([sign, upright])
        return cls(side, away * signs, origin, signs)

    def place(self, point: Floats) -> Floats:
        """A point of the line in the picture."""
        place: Floats = self.origin + self.signs * point
        return place

    def angles(self, heights: tuple[float, float, float], state: str) -> UBendAngles:
        """Angles and radius; a section that is no hat is refused."""
        rise = float(self.line[:, 1].max())
        if not rise > max(heights):
            usual = ", ".join(f"{part * rise:.3g}" for part in (0.25, 0.5, 0.75))
            flat = rise < 0.01 * float(np.ptp(self.line[:, 0]) + rise)
            raise InvalidValue(
                "the wall of the section does not reach the heights at which it is measured",
                where="heights",
                value=f"{', '.join(f'{height:g}' for height in heights)}; the part ({state}) rises by {rise:.4g}",
                cause="a short stroke, or a part that is no hat",
                remedy="another plane, or a measure of the kind section" if flat else f"heights = [{usual}]",
            )
        found = u_bend_angles(self.line, heights, flange=max(len(self.line) // _FLANGE, 2))
        for what, angle in (("wall", found.theta1), ("flange", found.theta2)):
            if not _BENT[0] < angle < _BENT[1]:
                raise InvalidValue(
                    f"the section is no hat: it has no {what}",
                    where="springback",
                    value=f"an angle of {angle:.4g} degrees ({state})",
                    cause="a part without a bottom, a wall and a flange, or a plane along its rail",
                    remedy="another plane, or a measure of the kind section",
                )
        return found


def halves(cut: Section, along: Floats, planes: Sequence[Mirror]) -> Iterator[Half]:
    """The computed half of a section that begins in a plane of symmetry; else both of its halves."""
    line = cut.line(along)
    across = [plane for plane in planes if abs(along[plane.axis]) > 1.0 - 1e-9]
    if across:
        nearer = abs(line[0, 0] - across[0].at) <= abs(line[-1, 0] - across[0].at)
        yield Half.of("", line, 1.0) if nearer else Half.of("", line[::-1], -1.0)
        return
    middle = 0.5 * cut.s[-1]
    between = np.array([[np.interp(middle, cut.s, line[:, k]) for k in (0, 1)]])
    yield Half.of(", left", np.concatenate([between, line[cut.s < middle][::-1]]), -1.0)
    yield Half.of(", right", np.concatenate([between, line[cut.s > middle]]), 1.0)
