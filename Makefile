# Copyright 2026 The dewing authors
# SPDX-License-Identifier: Apache-2.0
# Every target sets up what it needs. PYTHON=... and VENV=... choose the interpreter and the folder.

VENV ?= .venv
BIN = $(VENV)/bin
PYTEST_OPTIONS ?=
DEMO_OPTIONS ?= --force
BENCH_OPTIONS ?=

.PHONY: help venv demo test lint bench bench-peers clean

help:
	@echo 'make demo   the closed loop over ROS 2: simulator and controller as two processes'
	@echo 'make test   linters and tests'
	@echo 'make lint   linters'
	@echo 'make bench  time per step'
	@echo 'make bench-peers  time of a plate beside NGSolve and OpenFOAM, where these are installed'
	@echo 'make venv   set up $(VENV) only'
	@echo 'make clean  remove what was built, but not results in out/'

venv:
	@python="$$(sh scripts/find_python)" && "$$python" scripts/environment.py '$(VENV)'

demo: venv
	@$(BIN)/dewing demo --force $(DEMO_OPTIONS)

lint: venv
	@$(BIN)/ruff check .
	@$(BIN)/flake8

test: lint
	@$(BIN)/python -m pytest $(PYTEST_OPTIONS)

bench: venv
	@$(BIN)/dewing bench $(BENCH_OPTIONS)
	@$(BIN)/python benchmarks/roundtrip.py

bench-peers: venv
	@OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 \
		$(BIN)/python benchmarks/peers/compare.py --json out/peers.json --force

clean:
	rm -rf '$(VENV)' build dist install log *.egg-info .pytest_cache .ruff_cache .hypothesis
