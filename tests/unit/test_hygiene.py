"""What no source file of the package may hold, beyond what the linter refuses."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import separatrix

SOURCE = Path(separatrix.__file__).parent
MODULES = sorted(SOURCE.rglob("*.py"))
TEXTS = sorted(path for path in SOURCE.rglob("*") if path.suffix in {".py", ".toml", ".md", ".csv"})
ROOT = SOURCE.parent.parent

LIMIT = 600


def calls(tree: ast.AST) -> set[str]:
    """Return the names of the functions that are called by a bare name."""
    return {n.func.id for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)}


def test_files_and_most_functions_are_short_and_floating_point_is_strict():
    """95 % of functions are under 40 lines, docstring not counted; no fast-math, no threads in a kernel."""
    sizes = []
    for path in MODULES:
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"fastmath\s*=\s*True|parallel\s*=\s*True", text), path
        assert len(text.splitlines()) < LIMIT, path
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef):
                body = node.body[1:] if ast.get_docstring(node) else node.body
                sizes.append(node.end_lineno - body[0].lineno + 1 if body else 0)
    assert sorted(sizes)[int(0.95 * len(sizes))] < 40


def test_nothing_names_a_machine_or_an_index():
    """No path of a machine and no address of a package index, in sources or at the root."""
    kinds = {".toml", ".txt", ".md", ""}
    root = [p for p in ROOT.iterdir() if p.is_file() and p.suffix in kinds and p.name != ".git"]
    for path in (*TEXTS, *root):
        text = path.read_text(encoding="utf-8", errors="replace")
        assert not re.search(r"/(home|root|work|Users|tmp)/\w|index-url|https?://\S*/simple", text), path


def compiled(tree: ast.Module) -> dict[str, str]:
    """Return how each compiled function of a module is compiled, by name."""
    decorated = {n.name: {ast.unparse(one) for one in n.decorator_list} for n in functions(tree)}
    return {name: how.pop() for name, how in decorated.items() if how & {"kernel", *PARTS}}


def functions(tree: ast.Module) -> list[ast.FunctionDef]:
    """Return the functions of a module and the methods of its classes."""
    bodies = [tree.body, *(one.body for one in tree.body if isinstance(one, ast.ClassDef))]
    return [one for body in bodies for one in body if isinstance(one, ast.FunctionDef)]


PARTS = {"part", "inlined", "unfolded"}


def test_python_calls_kernels_and_no_parts_of_them():
    """A part that Python calls is compiled at each start: only a kernel is kept. `queue` makes a kernel."""
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in MODULES}
    names = {path: ".".join(path.relative_to(SOURCE.parent).with_suffix("").parts) for path in MODULES}
    kinds = {names[path]: compiled(tree) for path, tree in trees.items()}
    for path, tree in trees.items():
        imports = [one for one in ast.walk(tree) if isinstance(one, ast.ImportFrom)]
        taken = [(kinds.get(one.module or "", {}).get(a.name), a.name) for one in imports for a in one.names]
        ways = (*taken, *((how, n) for n, how in kinds[names[path]].items()))
        parts = {name for how, name in ways if how in PARTS}
        plain = [one for one in functions(tree) if one.name not in (*kinds[names[path]], "queue")]
        assert not {(one.name, called) for one in plain for called in calls(one) & parts}, path


TESTED = "test = [{material='a', counterface='b', medium='c', friction=1}]"
LIGHT = {
    "import separatrix, separatrix.front.cli": "numpy scipy numba matplotlib xarray",
    "from separatrix.front import main; main(['bearing', 'ball-218', '--json', '--quiet'])": (
        "scipy.optimize pandas matplotlib xarray pydantic"
    ),
    "from separatrix.front import main; main(['materials', 'list', '--json'])": "numba scipy matplotlib",
    "from separatrix.friction.friction_file import FrictionFile; from separatrix.ground import reader; "
    f'reader.read_text(FrictionFile, "{TESTED}", "")': "numpy",
}
"""What starts quickly: a program, and the large libraries that it does without."""


@pytest.mark.parametrize("program", LIGHT)
def test_a_start_loads_what_it_needs(program):
    """The package, the command line's own modules, and a short verb, whose start is most of its time."""
    code = f"import sys; {program}; sys.exit(str({{*{LIGHT[program].split()}}} & {{*sys.modules}} or ''))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stderr.strip() == ""


def test_every_public_name_can_be_imported_and_no_file_name_stands_twice():
    """Each name in `separatrix.__all__` is there, and an unknown one is refused as Python does."""
    for name in separatrix.__all__:
        assert getattr(separatrix, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'separator'"):
        separatrix.separator  # noqa: B018
    # nor does a file's name stand twice: a reader guesses the file from the name of the thing
    names = [path.name for path in MODULES if path.name != "__init__.py"]
    assert sorted(names) == sorted(set(names))
