"""Free bending of a strip over a cylinder, and what the number of contact points does to the curve."""

from umform_book.case import Chapter
from umform_book.free_bending import contact_points, reproduction

CHAPTER = Chapter(
    "The paper",
    "Free bending of a strip over a cylinder, and what the number of contact points does to the curve.",
    (reproduction.CASE, contact_points.CASE),
)
