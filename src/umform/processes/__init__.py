"""Ready parametric forming processes."""
