PYTHON ?= python3
BIN := .venv/bin
# A file of tests is one worker's, so that what its tests share is made once.
TESTS := $(BIN)/pytest -n auto --maxprocesses 8 --dist loadfile --no-loadscope-reorder

# Modules compiled to bytecode are kept, which halves the start of every command.
unexport PYTHONDONTWRITEBYTECODE

BROWSER_TESTS := $(BIN)/pytest -q browser_tests -c browser_tests/pytest.ini

.PHONY: demo test browser-test check bench docs clean kernels wheel wheel-check

demo: .venv/ready ## rank the paper's seven cage materials
	$(BIN)/separatrix demo --out demo

test: kernels ## every test
	$(TESTS)

kernels: .venv/ready
	@$(BIN)/python tests/kernels.py

check: kernels docs ## what reviewers run: lint, types, layers, docs, tests
	$(BIN)/pip install --quiet --constraint constraints.txt --editable '.[lint]'
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/mypy --config-file benchmarks/mypy.ini benchmarks
	$(BIN)/lint-imports
	$(TESTS)

browser-test: kernels ## the local page in Chromium, which the system has
	@command -v chromium > /dev/null || { echo 'Chromium is missing: apt-get install chromium'; exit 1; }
	@$(BIN)/python -c 'import axe_playwright_python, playwright' 2> /dev/null || \
	  $(BIN)/pip install --quiet --constraint constraints.txt --editable '.[browser]'
	$(BROWSER_TESTS)

bench: .venv/ready ## speeds; numbers go in benchmarks/README.md
	$(BIN)/pytest benchmarks --benchmark-only -p no:xdist

wheel: .venv/ready ## a package for this platform with compiled kernels, into dist/
	$(BIN)/python tools/wheel.py build

wheel-check: wheel ## install it where nothing can be written: the first answer compiles nothing
	$(BIN)/python tools/wheel.py check

docs: .venv/ready
	$(BIN)/pip install --quiet --constraint constraints.txt --editable '.[docs]'
	$(BIN)/sphinx-build -W -n docs docs/_build

clean:
	rm -rf .venv build demo dist docs/_build docs/generated

.venv/ready: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "separatrix needs Python 3.11 or later; name one: make PYTHON=python3.11")'
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check --no-compile --constraint constraints.txt --editable '.[test]'
	@touch $@
