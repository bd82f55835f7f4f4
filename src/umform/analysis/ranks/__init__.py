"""A run that is shared by ranks."""
