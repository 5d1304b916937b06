# Each target works alone on a fresh machine with Python 3.11 or later, a C compiler, make and git.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
DEMO := $(VENV)/demo
READY := $(VENV)/ready
SITE := $(VENV)/site
CROSS := $(VENV)/cross

.PHONY: help setup demo test test-all packages test-target mutation fuzz lint check cross bench studies site dist clean

help: ## what can be made
	@sed -n 's/^\([a-z-]*\):.*## /  make \1\t/p' Makefile

PACKAGES := $(patsubst %/pyproject.toml,%,$(wildcard packages/*/pyproject.toml))
INSTALLED := pyproject.toml setup.py constraints.txt $(PACKAGES:=/pyproject.toml) packages/fmuloop/setup.py packages/fmuloop/src/fmuloop/steps.c
FOLDERS := models fmus harness

define environment
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Python 3.11 or later is needed; $(PYTHON) is `$(PYTHON) --version`. Try make PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv $(VENV)
endef
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt $(PIP_OPTIONS) $(PACKAGES:%=--editable ./%) --editable

$(DEMO): $(INSTALLED)
	$(environment)
	$(INSTALL) '.[replay]'
	@touch $@

$(READY): $(INSTALLED)
	$(environment)
	$(INSTALL) '.[recordings,replay,design,identification,cluster,notebook,dev$(MORE)]'
	@touch $(DEMO) $@

setup: $(READY) ## the virtual environment alone, with all that the other targets need

demo: $(DEMO) ## build the FMUs, compare with and without damping, replay a short drive
	$(BIN)/driveline build
	$(BIN)/driveline compare --replace
	$(BIN)/driveline replay harness/manoeuvres/data/town_drive.csv --replace

# bytecode is kept, whatever the environment says: tests are collected in half the time
# and workers that share the cores start no threads of their own
TEST := PYTHONDONTWRITEBYTECODE= OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist worksteal

test: $(READY) ## the tests but the slow ones; once set up, without network
	$(TEST) -m 'not slow'

test-all: $(READY) ## all tests
	$(TEST)

packages: $(READY) ## each package alone: its wheel in an empty environment, and its tests there
	$(BIN)/python -m tests.alone

test-target: $(READY) ## the controller's C on an emulated processor; says what to apt-get install
	$(BIN)/python -m docs.studies.target_deviations
	$(BIN)/python -m pytest tests/fmus/target tests/harness/exchange/target

mutation: $(READY) ## a sample of small faults, put into the code one by one: do the tests find them?
	$(BIN)/python -m tests.mutation

fuzz: $(READY) ## odd calls, files and options by the thousand
	$(BIN)/python -m tests.fuzz --json fuzz.json

lint: $(READY) ## format, lint, the order of the rooms, and types
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	@for package in $(FOLDERS); do ln -sfn ../$$package driveline/$$package; done # they see the package as it is installed
	$(BIN)/lint-imports --no-cache --no-logo
	$(BIN)/basedpyright

check: $(READY) ## build the FMUs and run every compliance check on them
	$(BIN)/driveline build
	$(BIN)/driveline check build/*.fmu
	$(BIN)/driveline check build/native/*.fmu

$(CROSS): $(READY)
	$(INSTALL) '.[cross]'
	@touch $@

cross: $(CROSS) ## what compiles native FMUs for all platforms, and those FMUs
	$(BIN)/driveline build --build native --platform all

bench: $(READY) ## what a step, a run and a command take, side by side and in other hosts
	$(BIN)/driveline build
	$(BIN)/python -m docs.studies speed
	$(BIN)/python -m benchmarks.step_error
	$(BIN)/python -m benchmarks.standstill

studies: $(READY) ## all numbers of the documentation, measured anew for hours; says which have moved
	$(BIN)/driveline build
	$(BIN)/python -m docs.studies

$(SITE): $(READY)
	$(INSTALL) '.[site]'
	@touch $@

site: $(SITE) ## the documentation as a site, into site/; once its packages are installed, without network
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict

dist: $(READY) ## what is published, in dist/: the sources and wheels of all packages, checked, and an archive of FMUs for all platforms
	$(INSTALL) '.[publish,cross]'
	rm -rf dist
	$(BIN)/python -m driveline.harness.explorer
	for package in . $(PACKAGES); do $(BIN)/python -m build --no-isolation --outdir dist $$package || exit 1; done
	PATH="$(BIN):$$PATH" auditwheel repair --wheel-dir dist dist/*-linux_*.whl
	rm dist/*-linux_*.whl
	$(BIN)/twine check --strict dist/*
	$(BIN)/python -m docs.studies.archive dist
	@! grep -q github.com/OWNER pyproject.toml || echo "not to be published yet: pyproject.toml does not name the repository"

clean: ## everything that was made
	rm -rf $(VENV) build dist results site fuzz.json .pytest_cache *.egg-info packages/fmuloop/src/fmuloop/_steps.* harness/explorer/page/loops.json
