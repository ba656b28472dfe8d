"""How Sphinx builds the documentation: `make docs`."""

from __future__ import annotations

from importlib.metadata import version as installed_version

project = "separatrix"
author = "The separatrix founders"
project_copyright = "2026, the separatrix founders"
release = installed_version("separatrix")
version = release

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "numpydoc"]
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath", "fieldlist"]
myst_heading_anchors = 4
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}  # numpydoc looks for the second
exclude_patterns = ["_build"]
html_theme = "furo"
html_title = "separatrix"
math_number_all = False
numpydoc_class_members_toctree = False
numpydoc_show_class_members = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autosummary_generate = False
