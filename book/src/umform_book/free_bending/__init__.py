"""Free bending of a strip over a cylinder, and the effect of the number of contact points."""

from umform_book.case import Chapter
from umform_book.free_bending import contact_points, reproduction

CHAPTER = Chapter(
    "The paper",
    "Free bending of a strip over a cylinder, and the effect of the number of contact points.",
    (reproduction.CASE, contact_points.CASE),
)
