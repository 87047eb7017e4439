# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
# Every target sets up what it needs. PYTHON=... and VENV=... choose the interpreter and the folder.

VENV ?= .venv
BIN = $(VENV)/bin
SPHINX = $(VENV)-docs/bin/python -m sphinx --keep-going -j auto
# Linted by name: what else lies beside the sources, such as an environment, is not ours.
SOURCES = setup.py benchmarks config dewing_cli dewing_control dewing_sim dewing_sysid docs \
	examples launch scripts test
PYTEST_OPTIONS ?=
DEMO_OPTIONS ?= --force
BENCH_OPTIONS ?=

.PHONY: help venv demo test lint bench bench-peers kernels-wheel docs docs-venv links long clean

help:
	@echo 'make demo   the closed loop over ROS 2: simulator and controller as two processes'
	@echo 'make test   linters and tests'
	@echo 'make lint   linters'
	@echo 'make bench  time per step'
	@echo 'make bench-peers  time of a plate beside NGSolve and OpenFOAM, where these are installed'
	@echo 'make kernels-wheel  compiled kernels as a wheel in dist/, for this Python and processors with AVX2'
	@echo 'make docs   the browsable documentation, in build/docs; warnings are errors'
	@echo 'make links  the external links of the documentation, over the network'
	@echo 'make long   every command of the documentation that takes long, an hour or more'
	@echo 'make venv   set up $(VENV) only'
	@echo 'make clean  remove what was built, but not results in out/'

venv:
	@python="$$(sh scripts/find_python)" && "$$python" scripts/environment.py '$(VENV)'

demo: venv
	@$(BIN)/dewing demo --force $(DEMO_OPTIONS)

lint: venv
	@$(BIN)/ruff check $(SOURCES)
	@$(BIN)/flake8 $(SOURCES)

test: lint
	@$(BIN)/python -m pytest $(PYTEST_OPTIONS)

bench: venv
	@$(BIN)/dewing bench $(BENCH_OPTIONS)
	@$(BIN)/dewing bench --graph
	@$(BIN)/python benchmarks/roundtrip.py

bench-peers: venv
	@OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 \
		$(BIN)/python benchmarks/peers/compare.py --json out/peers.json --force

kernels-wheel: venv
	@$(BIN)/python scripts/kernels_wheel.py dist

docs: docs-venv
	@$(SPHINX) -W -q -b html docs build/docs
	@echo 'build/docs/index.html'

links: docs-venv
	@$(SPHINX) -b linkcheck docs build/links

docs-venv:
	@python="$$(sh scripts/find_python)" && \
		"$$python" scripts/environment.py '$(VENV)-docs' docs/requirements.txt

long: venv
	@$(BIN)/python scripts/documented_commands.py

clean:
	rm -rf '$(VENV)' '$(VENV)-docs' docs/autoapi build dist install log *.egg-info .pytest_cache .ruff_cache .hypothesis
	find dewing_* -name '*.nb[ic]' -delete
