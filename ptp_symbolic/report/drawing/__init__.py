"""The drawing of a platform: a scene of neutral primitives, written as TikZ or as SVG."""

from ptp_symbolic.report.drawing.platform import PlatformDrawing, drawn
from ptp_symbolic.report.drawing.svg import svg_text
from ptp_symbolic.report.drawing.tikz import tikz_text

__all__ = ["PlatformDrawing", "drawn", "svg_text", "tikz_text"]
