"""The state of a formed part in files of other programs: written, and read back. docs/other-programs.md"""
