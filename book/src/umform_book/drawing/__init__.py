"""Drawing: cups compared with measurements, cups of known symmetry, and a sheet stretched over a punch."""

from umform_book.case import Chapter
from umform_book.drawing import aa6016_cup, hemispherical_stretch, s_rail, spherical_punch, square_cup, swift_cup

CHAPTER = Chapter(
    "Drawing",
    "Round and square cups compared with measurements; a cup and an S-rail that must be symmetric; a sheet stretched "
    "over a hemisphere, compared with a membrane; a disc drawn by a sphere, compared with other codes. The "
    "[U-bend](friction-u-bend.md) of NUMISHEET 93, also with [each kind of hardening](material-u-bend.md), is in the "
    "chapters on friction and on metals.",
    (swift_cup.CASE, aa6016_cup.CASE, hemispherical_stretch.CASE, spherical_punch.CASE, square_cup.CASE, s_rail.CASE),
)
