"""What every element must do before any problem is worth solving: patch tests, eigenvalues, invariance."""

from umform.verification.case import Chapter

CHAPTER = Chapter(
    "Elements",
    "What every element must do before any problem is worth solving: patch tests, eigenvalues, invariance.",
    (),
)
