"""Print requirements that pyproject.toml states, one a line: `build`, `run` or an extra such as `dev`."""

import sys
import tomllib
from pathlib import Path


def requirements(group: str) -> list[str]:
    """Requirements of a group; CMake and ninja belong to `build`, as no package of Debian is relied on."""
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())
    if group == "build":
        tools = project["tool"]["scikit-build"]
        versions = [f"{name}{tools[name]['version']}" for name in ("cmake", "ninja")]
        return project["build-system"]["requires"] + versions
    if group == "run":
        return project["project"]["dependencies"]
    return project["project"]["optional-dependencies"][group]


if __name__ == "__main__":
    for group in sys.argv[1:]:
        print(*requirements(group), sep="\n")
