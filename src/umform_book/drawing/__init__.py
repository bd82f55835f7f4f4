"""Drawing: the cup of AA6016-T4 beside the measured one, and cups of which symmetry tells the answer."""

from umform_book.case import Chapter
from umform_book.drawing import aa6016_cup, swift_cup

CHAPTER = Chapter(
    "Drawing",
    "The cup of AA6016-T4 beside the measured one, and cups of which symmetry tells the answer.",
    (swift_cup.CASE, aa6016_cup.CASE),
)
