# Two commands matter: `make demo` and `make test`. Each sets up what it needs in .venv, once.
# `make docs` makes the site, docs/_build/html/index.html, without a network.
# `make lint` is the part of `make test` that takes seconds: rules, format and types.
# `make lowest` tests with the lowest versions that pyproject.toml allows, in a .venv-lowest; TESTS=file some of it.
# `make fuzz TIME=3600` looks for inputs that fail, for as many seconds.

# The first Python on the path that is new enough; `make PYTHON=/path/to/python test` chooses another.
NEW_ENOUGH := import sys, venv; sys.exit(sys.version_info < (3, 11))
PYTHON ?= $(shell for p in python3.11 python3.12 python3.13 python3 python3.14 python; do \
	$$p -c '$(NEW_ENOUGH)' >/dev/null 2>&1 && echo $$p && break; done)

VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready

# Files of tests run side by side, one a core; a file stays together, so that what it compiles is compiled once.
TOGETHER := -n auto --dist loadfile

.PHONY: demo docs test test-all lowest fuzz lint clean

demo: $(READY)
	$(BIN)/dt3d demo --out out

# -W: a warning is an error; --keep-going: all of them are shown
docs: $(READY)
	$(BIN)/python -m sphinx -b html -c docs -W --keep-going -q . docs/_build/html
	@echo "docs/_build/html/index.html"

test: lint
	$(BIN)/python -m pytest $(TOGETHER)

test-all: lint
	$(BIN)/python -m pytest $(TOGETHER) -m "slow or not slow"

# uv chooses versions, pip has no such choice; --constraint holds them when the tools for tests are added
LOWEST := .venv-lowest

lowest: $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check uv
	$(BIN)/uv venv --quiet --clear --python $(BIN)/python $(LOWEST)
	$(BIN)/uv pip compile --quiet --python $(LOWEST)/bin/python --resolution lowest-direct --extra view --extra formats \
		pyproject.toml --output-file $(LOWEST)/lowest.txt
	$(BIN)/uv pip install --quiet --python $(LOWEST)/bin/python --constraint $(LOWEST)/lowest.txt --editable ".[view,test]"
	$(LOWEST)/bin/python -m pytest $(TOGETHER) $(TESTS)

TIME ?= 60

fuzz: $(READY)
	$(BIN)/python -m tests.fuzz --seconds $(TIME)

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

clean:
	rm -rf $(VENV) $(LOWEST) out build dist docs/_build *.egg-info .pytest_cache .hypothesis .ruff_cache .mypy_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# Debian ships a venv module that cannot install pip; then the pip outside puts one inside.
$(READY): pyproject.toml
	@if [ -z "$(PYTHON)" ]; then \
		echo "dt3d needs Python 3.11 or newer; found: $$(python3 --version 2>&1 || true)" >&2; \
		echo "install one, or name it: make PYTHON=/path/to/python3.11 $(MAKECMDGOALS)" >&2; exit 1; fi
	@$(PYTHON) -c '$(NEW_ENOUGH)' || { \
		echo "dt3d needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version 2>&1)" >&2; exit 1; }
	@test -x $(BIN)/python && $(BIN)/python -m pip --version >/dev/null 2>&1 \
		|| $(PYTHON) -m venv --clear $(VENV) \
		|| { $(PYTHON) -m venv --clear --without-pip $(VENV) && $(PYTHON) -m pip --python $(BIN)/python install pip; }
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[view,test]"
	@touch $@
