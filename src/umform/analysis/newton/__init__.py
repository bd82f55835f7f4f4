"""Newton's method, its convergence criteria, and one increment of a run."""
