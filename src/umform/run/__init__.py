"""A whole run: `solve` starts one, `resume` continues one from its checkpoint; both return a `Result`."""

from umform.run.execute import resume, solve
from umform.run.result import Result

__all__ = ["Result", "resume", "solve"]
