"""Formulas as MathML, by the converter of docutils: no script, no font and no network is needed."""

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

# A function such as sin beside a factor: a thin space, which TeX sets and the converter does not.
FUNCTION = re.compile(
    r"(</(?:msub|msup|msubsup|mfrac|mrow|mi|mn)>\s*)"
    r"(<mi[^>]*>\w+</mi>\s*<mo>&ApplyFunction;</mo>)"
)
THIN_SPACE = r'\1<mspace width="0.17em"></mspace>\2'

LOGGER = logging.getLogger(__name__)


def setup(app: Sphinx) -> dict[str, Any]:
    """Offer the renderer `formulas` for `html_math_renderer`."""
    app.add_html_math_renderer(
        "formulas", inline_renderers=(inline, None), block_renderers=(display, None)
    )
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}


def inline(translator: Any, node: nodes.Element) -> None:
    """Write a formula within a line."""
    translator.body.append(_mathml(node.astext(), node, as_block=False))
    raise nodes.SkipNode


def display(translator: Any, node: nodes.Element) -> None:
    """Write a formula of its own, with its number where it has one."""
    number = node.get("number")
    label = "" if number is None else f'<span class="eqno">({number})</span>'
    anchor = f' id="{node["ids"][0]}"' if node.get("ids") else ""
    formula = _mathml(node.astext(), node, as_block=True)
    translator.body.append(f'<div class="formula"{anchor}>{formula}{label}</div>\n')
    raise nodes.SkipNode


def _mathml(latex: str, node: nodes.Element, as_block: bool) -> str:
    """MathML of a formula; one that cannot be read is a warning, which ends the build."""
    try:
        return FUNCTION.sub(THIN_SPACE, str(tex2mathml(latex, as_block=as_block)))
    except MathError as error:
        LOGGER.warning("formula %r: %s", latex, error, location=node)
        return f"<code>{latex}</code>"
