"""Random jobs such as users give: each is drawn from its number alone, and is the same on every machine."""

from jobs.job import COUNT, KINDS, Done, Job, job

__all__ = ["COUNT", "KINDS", "Done", "Job", "job"]
