"""``python -m umform.cli``."""

from umform.cli import main

if __name__ == "__main__":
    main()
