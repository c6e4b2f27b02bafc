"""Lists fonts, shapes texts, and says where texts are drawn. The manual is docs/python.md."""

from ._text import Shaped, boxes, fonts, shape

__all__ = ["Shaped", "boxes", "fonts", "shape"]
