"""Finite strains and plastic flow, against closed forms and converged solutions."""

from umform.verification.case import Chapter

CHAPTER = Chapter(
    "Elasto-plastic",
    "Finite strains and plastic flow, against closed forms and converged solutions.",
    (),
)
