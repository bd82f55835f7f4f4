"""Sphinx configuration of the documentation site: `make docs`."""

import os
import sys
from pathlib import Path

from numpydoc.xref import DEFAULT_LINKS

import umform

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

project = "umform"
author = "The umform developers"
copyright = author
version = release = umform.__version__
root_doc = "index"
exclude_patterns = ["site/templates"]

extensions = [
    "myst_nb",  # MyST pages, and notebooks with their outputs
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx.ext.mathjax",
    "sphinx_design",
    "sphinx_copybutton",
    "extensions.links",
    "extensions.equations",
    "extensions.docstrings",
    "extensions.versions",
]

# The pages are Markdown that a forge shows too.
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # a page may begin a chapter below its title

# Notebooks are executed once, until they or umform change.
nb_execution_mode = "cache"
nb_execution_cache_path = str(HERE.parents[1] / "build" / "docs-notebooks")
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True

# The public names, with their docstrings.
autosummary_generate = True
autosummary_imported_members = False
autosummary_ignore_module_all = False
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = False  # signatures name the fields of a Spec that stand in no source
ALIASES = (
    "AnyFriction ArrayLike Cells Direction Floats FrictionFunction Gap GapFunction Layers Material Positive Rolling "
    "Selector Stiffness Vector"
)
autodoc_type_aliases = {name: name for name in ALIASES.split(" ")}
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 90
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "inherited-members": True}
numpydoc_show_class_members = False
numpydoc_xref_param_type = True
numpydoc_xref_aliases = {name: name for name in DEFAULT_LINKS}  # theirs lead to pages on other sites
nitpicky = True
nitpick_ignore_regex = [
    (r"py:(obj|class)", ".*"),  # types, and words in backticks, most of which are no public names
    (r"py:\w+", r"(?!umform\.).*"),  # short names: a link where there is one
    (r"py:(mod|func)", r"umform\.(analysis|model)\.\w+(\.\w+)*"),  # the rooms behind the public names
]
highlight_language = "none"  # a block of Markdown says what it is
default_role = "py:obj"  # a name in backticks is a link where there is such a name
templates_path = [str(HERE / "templates")]

# Nothing is fetched from a network: neither by the build nor by a page.
html_theme = "pydata_sphinx_theme"
html_title = f"umform {release}"
html_static_path = ["static"]
html_css_files = ["umform.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {
    "logo": {"text": "umform"},
    "navbar_end": ["version-switcher", "theme-switcher"],
    "navbar_align": "left",
    "header_links_before_dropdown": 7,
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "show_prev_next": True,
    "footer_start": ["copyright"],
    "footer_end": [],
    # Beside the folders of the versions, written by extensions/versions.py; relative to the root of a version.
    "switcher": {"json_url": "../switcher.json", "version_match": version},
    "check_switcher": False,
}
html_sidebars = {"index": []}
versions_url = os.environ.get("DOCS_URL", "/")
