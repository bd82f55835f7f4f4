"""The state of a sheet carried over: to other elements, after a cut, to another place."""
