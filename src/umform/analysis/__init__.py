"""A run: Newton's method, the steps that it takes, and the whole of them."""
