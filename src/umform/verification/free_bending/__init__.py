"""Free bending of a strip over a cylinder, and what the number of contact points does to the curve."""

from umform.verification.case import Chapter

CHAPTER = Chapter(
    "The paper",
    "Free bending of a strip over a cylinder, and what the number of contact points does to the curve.",
    (),
)
