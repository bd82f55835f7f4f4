"""Bends whose radius is near the thickness: which thickness strain they need."""

from umform.verification.case import Chapter

CHAPTER = Chapter(
    "Sharp bends",
    "Bends whose radius is near the thickness: which thickness strain they need.",
    (),
)
