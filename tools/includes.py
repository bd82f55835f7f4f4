"""Print the include options that the bindings need beside the headers of umform: Python's and nanobind's."""

import sysconfig

import nanobind

print("-isystem", sysconfig.get_paths()["include"], "-isystem", nanobind.include_dir())
