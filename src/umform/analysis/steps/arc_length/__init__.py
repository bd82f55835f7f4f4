"""Arc-length continuation: the load parameter is an additional unknown, the arc length an additional equation."""
