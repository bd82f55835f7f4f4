"""Path following by arc length: the load parameter is one more unknown, the arc length one more equation."""
