# thirdbody: everything runs in its own environment, .venv, made on first use.
#
#   make demo     solve an example, redraw the figures of the paper, say where they are
#   make test     the physics and the interfaces
#   make check    types, style, layers, book, gallery, packaging, browser, planted slips, long studies
#   make docs     the book, into docs/_build/html, a folder for a static host; it needs no network
#   make oldest   make test with the oldest releases that pyproject.toml allows
#   make coverage which lines make test runs
#   make bench    speed, into benchmarks/results.md
#   make pictures the pictures of the README, into docs/images
#   make format   tidy the code
#   make clean    remove what these commands made
#
# Another interpreter: make PYTHON=python3.12 test

PYTHON  ?= python3
VENV    := .venv
OLDEST  := .venv-oldest
RUN     := $(VENV)/bin
OUT     ?= demo
WORKERS ?= auto
PIP     := install

# one thread for each worker: the arrays are small, and workers must not fight for cores
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
export MPLBACKEND ?= Agg
# commands that tests start are compiled once, not at every start
unexport PYTHONDONTWRITEBYTECODE

# files, not single tests, lie beside each other on a worker: what they share is made once
PYTEST   = $(RUN)/python -m pytest -q -n $(WORKERS) --dist worksteal --durations 10
QUICK    = -m "not check and not slow"

.PHONY: help demo test check style types layers long docs oldest coverage bench pictures browser
.PHONY: format clean

help:
	@sed -n '3,14s/^# \{0,1\}//p' Makefile

$(RUN)/python:
	$(PYTHON) -c 'import sys; v = sys.version_info; sys.exit(v < (3, 11) and f"thirdbody needs Python 3.11 or newer; {sys.executable} is {v.major}.{v.minor}. Try make PYTHON=python3.12 ...")'
	$(PYTHON) -m venv $(VENV)

# editable, so that what you change is what runs
$(VENV)/installed: pyproject.toml | $(RUN)/python
	$(RUN)/python -m pip $(PIP) --quiet --editable .
	@touch $@

$(VENV)/installed-test: pyproject.toml | $(RUN)/python
	$(RUN)/python -m pip $(PIP) --quiet --editable '.[test]'
	@touch $@ $(VENV)/installed

$(VENV)/installed-docs: pyproject.toml | $(RUN)/python
	$(RUN)/python -m pip $(PIP) --quiet --editable '.[docs]'
	@touch $@ $(VENV)/installed

demo: $(VENV)/installed
	$(RUN)/thirdbody solve examples/dusty_ball_screw.toml
	$(RUN)/thirdbody reproduce horng2022 --out $(OUT)
	@echo
	@echo "Open $(abspath $(OUT))/index.html in a browser. Beside it: each figure as PNG, SVG and CSV,"
	@echo "and the ledger of the paper's 84 statements, claims.json."

test: $(VENV)/installed-test
	$(PYTEST) $(QUICK)

# with make -k, all four even where one fails
check: style types layers long

style: $(VENV)/installed-test
	$(RUN)/ruff check .
	$(RUN)/ruff format --check .

types: $(VENV)/installed-test
	$(RUN)/python -m mypy

layers: $(VENV)/installed-test
	$(RUN)/lint-imports

long: $(VENV)/installed-test $(VENV)/installed-docs
	$(PYTEST) -m "check or slow"

oldest:
	$(MAKE) VENV=$(OLDEST) $(OLDEST)/floors.txt
	$(MAKE) VENV=$(OLDEST) PIP='install --constraint $(OLDEST)/floors.txt' test

$(VENV)/floors.txt: pyproject.toml tests/floors.py | $(RUN)/python
	$(RUN)/python tests/floors.py > $@

# of the lines that Python runs: those of the compiled engine and of other processes are not seen
coverage: $(VENV)/installed-test
	$(PYTEST) $(QUICK) --cov --cov-report term:skip-covered

docs: $(VENV)/installed-docs
	$(RUN)/python docs/versions.py docs/_build/html
	@echo "Open $(abspath docs/_build/html)/index.html in a browser."

bench: $(VENV)/installed-test
	$(RUN)/python benchmarks/run.py
	$(RUN)/python benchmarks/sweep.py
	$(RUN)/python benchmarks/waiting.py commands --page
	$(RUN)/python benchmarks/engine_accuracy.py --page
	$(RUN)/python benchmarks/engine_matrix.py --seconds 0.3 --page

pictures: $(VENV)/installed-test
	$(RUN)/python docs/figures/pictures.py

# a browser for the tests of the page, where none is found and one can be had; they skip without
browser: $(VENV)/installed-test
	@$(RUN)/python tests/app/browser.py

format: $(VENV)/installed-test
	$(RUN)/ruff check --fix .
	$(RUN)/ruff format .

clean:
	rm -rf $(VENV) $(OLDEST) $(OUT) build dist src/*.egg-info .ruff_cache .mypy_cache .import_linter_cache .hypothesis .coverage
	rm -rf docs/_build docs/_cases docs/cases docs/gallery docs/api
	find src tests -name __pycache__ -type d -prune -exec rm -rf {} +
