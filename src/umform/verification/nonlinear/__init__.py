"""Large displacements and rotations, elastic: the benchmarks of Sze, Liu & Lo (2004)."""

from umform.verification.case import Chapter

CHAPTER = Chapter(
    "Nonlinear obstacle course",
    "Large displacements and rotations, elastic: the benchmarks of Sze, Liu & Lo (2004).",
    (),
)
