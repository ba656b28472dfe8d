"""How Sphinx builds the documentation: `make docs`."""

from __future__ import annotations

import ast
import contextlib
import io
import runpy
import sys
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib

import separatrix

sys.path.insert(0, str(Path(__file__).parent))
from reference_tables import credibility_claims, json_page, quantities_page, study_page

matplotlib.use("agg")  # not in the environment: the notebooks draw in their own way

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "separatrix"
author = "The separatrix founders"
project_copyright = "2026, the separatrix founders"
release = installed_version("separatrix")
version = release

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "sphinx-mathjax-offline", "numpydoc"]
nb_execution_mode = "force"  # the notebooks are stored without outputs
nb_execution_raise_on_error = True
nb_execution_timeout = 300
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath", "fieldlist"]
myst_heading_anchors = 4
source_suffix = {
    ".md": "myst-nb",
    ".ipynb": "myst-nb",
    ".rst": "restructuredtext",
}  # numpydoc looks for the second
exclude_patterns = ["_build", "jupyter_execute", "generated/credibility-claims.md"]  # included in a page
html_theme = "furo"
html_title = "separatrix"
math_number_all = False
numpydoc_class_members_toctree = False
numpydoc_show_class_members = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autosummary_generate = False

REFERENCE = """# Python

After this page you can look up any public function or record: every name in `dir(separatrix)`, under the
module that holds it. All numbers are in SI units; each array has its shape and unit in the docstring. To
begin, see [compute in Python](../tutorials/python.md) and the [gallery](gallery.md).
"""
GALLERY = """# Gallery

After this page you can copy a script for your own question. Each script of `examples/` is shown with
what it prints and its figure. All of them are run when this page is built, and by the tests.
"""
SECTION = """
## {title}

![{title}]({name}.png)

```text
{printed}```

```{{literalinclude}} ../../examples/{name}.py
:language: python
```
"""


def write_gallery(app: Sphinx) -> None:
    """Run every example; write the page of their figures, texts and sources."""
    folder = Path(app.srcdir) / "generated"
    folder.mkdir(exist_ok=True)
    page = GALLERY
    for script in sorted((folder.parents[1] / "examples").glob("*.py")):
        title = (ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or "").rstrip(".")
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            left = runpy.run_path(str(script))
        left["figure"].savefig(folder / f"{script.stem}.png", dpi=100)
        page += SECTION.format(title=title, name=script.stem, printed=printed.getvalue())
    (folder / "gallery.md").write_text(page, encoding="utf-8")


def write_reference(app: Sphinx) -> None:
    """Write the page of the public names, under the modules that hold them."""
    page = REFERENCE
    homes: dict[str, list[str]] = {}
    for name in sorted(set(dir(separatrix)) - {"__version__"}):
        found = getattr(separatrix, name)
        kind = "autoclass" if isinstance(found, type) else "autofunction"
        stage = found.__module__.split(".")[1]
        members = "\n   :members:" if kind == "autoclass" else ""
        homes.setdefault(stage, []).append(f".. {kind}:: separatrix.{name}{members}\n")
    for stage, names in sorted(homes.items()):
        page += f"\n## {stage}\n\n```{{eval-rst}}\n" + "\n".join(names) + "```\n"
    (Path(app.srcdir) / "generated" / "python.md").write_text(page, encoding="utf-8")


def write_tables(app: Sphinx) -> None:
    """Write the pages of keys, names in the documents and quantities, and a part of that of credibility."""
    folder = Path(app.srcdir) / "generated"
    (folder / "study-keys.md").write_text(study_page(), encoding="utf-8")
    (folder / "json-names.md").write_text(json_page(), encoding="utf-8")
    (folder / "credibility-claims.md").write_text(credibility_claims(), encoding="utf-8")
    (folder / "nomenclature.md").write_text(quantities_page(), encoding="utf-8")


def setup(app: Sphinx) -> None:
    """Write the generated pages before the pages are read."""
    app.connect("builder-inited", write_gallery)
    app.connect("builder-inited", write_reference)
    app.connect("builder-inited", write_tables)
