"""Random jobs of drawing and forming, such as users give: each is drawn from its number alone."""

from forming.kinds import FORMING

__all__ = ["FORMING"]
