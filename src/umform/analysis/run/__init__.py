"""A whole run: `solve` starts one, `resume` continues one from its checkpoint; both return a `Result`."""

from umform.analysis.run.execute import resume, solve
from umform.analysis.run.result import Result

__all__ = ["Result", "resume", "solve"]
