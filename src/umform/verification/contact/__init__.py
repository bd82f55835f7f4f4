"""Rigid tools: pressure, penetration, Hertz, wrapping, rolling."""

from umform.verification.case import Chapter

CHAPTER = Chapter(
    "Contact",
    "Rigid tools: pressure, penetration, Hertz, wrapping, rolling.",
    (),
)
