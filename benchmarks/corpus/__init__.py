"""Small jobs of all kinds of forming whose balances are watched: each is the same on every machine."""

from corpus.jobs import JOBS, Watched

__all__ = ["JOBS", "Watched"]
