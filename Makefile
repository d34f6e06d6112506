# make run     the window on the built-in sample; SCENE=path/to/scene.npz for another
# make test    everything the tests need, then style, types, import contracts and all tests
# make bench   the project's figures, beside those peers that are installed; OPTIONS=--quick for a short run
# make bench-peers   the same, peers installed first: some 300 MB

SCENE ?= splash
PYTHON ?= python3
BIN := .venv/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check

.PHONY: run test bench bench-peers

run: .venv/installed
	@tools/run.sh "$(SCENE)"

test: .venv/installed-test
	@tools/system_libraries.sh test
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	QT_API=pyside6 QT_QPA_PLATFORM=xcb xvfb-run -a -s "-screen 0 1600x1000x24" $(BIN)/pytest

bench: .venv/installed
	$(BIN)/python benchmarks/run.py $(OPTIONS)

bench-peers: .venv/installed-peers
	@tools/system_libraries.sh peers
	$(BIN)/python benchmarks/run.py $(OPTIONS)

.venv/installed: pyproject.toml
	@PYTHON="$(PYTHON)" tools/make_venv.sh
	@echo "Installing Jaart and what it needs into .venv, once; this takes about a minute."
	@$(PIP) -e .
	@touch $@

.venv/installed-test: .venv/installed pyproject.toml
	@echo "Installing what the tests need into .venv."
	@$(PIP) -e ".[test]"
	@touch $@

.venv/installed-peers: .venv/installed pyproject.toml
	@echo "Installing the programs that Jaart is measured beside into .venv."
	@$(PIP) -e ".[peers]"
	@touch $@
