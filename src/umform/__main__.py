"""`python -m umform` is the command line."""

from umform.cli import main

main()
