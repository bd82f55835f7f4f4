"""A whole run: `solve` begins one, `resume` continues one from its checkpoint; both give a `Result`."""

from umform.run.execute import resume, solve
from umform.run.result import Result

__all__ = ["Result", "resume", "solve"]
