"""Results of a run: history, fields, balance of work and energies, shape."""
