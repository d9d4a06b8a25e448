"""Settings of Sphinx for these pages: all that a page needs lies in the folder that is built."""

import sys
from pathlib import Path

import ptp_symbolic

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "_extensions"))

project = "ptp-symbolic"
author = "The ptp-symbolic authors"
copyright = f"2026, {author}"
release = version = ptp_symbolic.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx_click",
    "sphinxcontrib.bibtex",
    "formulas",
    "effect_pages",
    "reference_pages",
    "concept_figures",
    "kept_outputs",
]
exclude_patterns = ["_build", "_generated", "tutorials/outputs"]

# Notebooks: `kept_outputs` fills the cache, so that nothing runs unless code was changed.
nb_execution_mode = "cache"
nb_execution_timeout = 600
nb_execution_raise_on_error = True
nb_render_markdown_format = "myst"
nb_merge_streams = True
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 3
# What the how-to pages and this site share: a link to a file that is no page stays a plain link.
suppress_warnings = ["mystnb.unknown_mime_type"]

bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "plain"

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # docstrings say shapes and units; types of arrays are no help to read

html_theme = "pydata_sphinx_theme"
html_title = "ptp-symbolic"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_math_renderer = "formulas"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "use_edit_page_button": False,
    "show_version_warning_banner": False,
    "navbar_end": ["theme-switcher"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
    "navigation_with_keys": False,
    "header_links_before_dropdown": 8,
}
