"""Small displacements: beams, plates and shells whose answers are known, by which locking shows."""

from umform.verification.case import Chapter
from umform.verification.linear import hemisphere

CHAPTER = Chapter(
    "Linear obstacle course",
    "Small displacements: beams, plates and shells whose answers are known, by which locking shows.",
    (hemisphere.CASE,),
)
