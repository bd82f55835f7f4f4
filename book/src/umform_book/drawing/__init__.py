"""Drawing: parts of known symmetry, and a sheet stretched over a punch."""

from umform_book.case import Chapter
from umform_book.drawing import hemispherical_stretch, one_step_blank, s_rail, spherical_punch, swift_cup

CHAPTER = Chapter(
    "Drawing",
    "A cup and an S-rail that must be symmetric; a sheet stretched over a hemisphere, compared with a membrane; a disc "
    "drawn by a sphere, compared with other codes. Cups beside measurements are in the first chapter; the "
    "[U-bend](friction-u-bend.md) of NUMISHEET 93, also with [each kind of hardening](material-u-bend.md), is in the "
    "chapters on friction and on metals.",
    (swift_cup.CASE, hemispherical_stretch.CASE, spherical_punch.CASE, s_rail.CASE, one_step_blank.CASE),
)
