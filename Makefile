# The two commands that a newcomer needs: make render, make test. Each installs what is missing, and nothing twice.
SHELL := /bin/bash
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
NATIVE := $(wildcard harness/native/*.c harness/native/*.h harness/native/cost/*.[ch]) CMakeLists.txt
SANITIZED := build/sanitize
BRDF_TESTS := $(wildcard tests/shaders/test_brdf_*.py tests/shaders/test_shade*.py tests/shaders/test_energy*.py)

PIP = $(BIN)/python -m pip install --quiet --disable-pip-version-check
EXTRA = import sys, tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"][sys.argv[1]], sep="\n")

# The packages of one of pyproject.toml's extras, without building ours again.
define install_extra
@echo "Installing what $(1) needs into $(VENV) ..."
@$(BIN)/python -c '$(EXTRA)' $(1) > $(VENV)/$(1).txt
@$(PIP) -r $(VENV)/$(1).txt
@touch $@
endef

.PHONY: help render test test-conformance test-backends test-sanitize test-exhaustive test-mutation fuzz bench cost trade \
        trade-readme lint format build submission models textures extremes clean

help: ## show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 20

render: $(VENV)/.harness ## the scene of project.sprj, to build/render.png
	@mkdir -p build
	$(BIN)/harness render project.sprj -o build/render.png --size 1920x1080 --supersample 2

test: $(VENV)/.harness $(VENV)/.test ## all tests
	$(BIN)/python -m pytest -n auto

test-conformance: $(VENV)/.harness $(VENV)/.test ## the pictures of SHADERed itself, case by case
	$(BIN)/python -m pytest -rA tests/harness/test_conformance.py

test-backends: $(VENV)/.harness $(VENV)/.test ## all tests by EGL, and by GLFW on a display of their own
	HARNESS_BACKEND=egl $(BIN)/python -m pytest
	HARNESS_BACKEND=glfw xvfb-run -a -s '-screen 0 1280x1024x24 -noreset' $(BIN)/python -m pytest

# SEED= repeats a run, CASE= one case of it; SECONDS=, CORPUS= (a folder with more projects).
fuzz: $(VENV)/.harness ## whether spoilt projects are refused and never crash (a minute; SEED=, SECONDS=)
	nice $(BIN)/python tests/fuzz/fuzz.py $(SEED:%=--seed %) $(SECONDS:%=--seconds %) $(CASE:%=--case %) $(CORPUS:%=--corpus %)

# Each shader with the tests that know it, so that others need not be run to see that they do not use it.
test-mutation: $(VENV)/.harness $(VENV)/.test ## whether the tests notice faults that are put into the shaders
	$(BIN)/harness mutate shaders/color.glsl --tests tests/shaders/test_color.py
	$(BIN)/harness mutate shaders/normal_map.glsl --tests tests/shaders/test_normal_map.py
	for file in brdf half rungs energy ladder; do $(BIN)/harness mutate shaders/$$file.glsl --tests $(BRDF_TESTS) || exit; done

test-sanitize: $(VENV)/bin/python ## the C library under AddressSanitizer and UBSan
	cmake -S . -B $(SANITIZED) -G Ninja -DCMAKE_BUILD_TYPE=Debug -DHARNESS_TESTS=ON -DHARNESS_SANITIZE=ON
	cmake --build $(SANITIZED)
	ctest --test-dir $(SANITIZED) --output-on-failure

test-exhaustive: $(VENV)/.harness $(VENV)/.test ## functions of one float at every float of their domain (minutes)
	$(BIN)/python -m pytest -rA --durations=0 tests/exhaustive/every_float.py

submission: $(VENV)/.harness $(VENV)/.test ## all there is to hand in, to build/submission.zip
	$(BIN)/harness submission project.sprj -o build/submission.zip

bench: $(VENV)/.harness $(VENV)/.bench ## speed and memory, beside numpy, numba and moderngl
	$(BIN)/python -m bench

cost: $(VENV)/.cost ## what the shading model costs on GPUs, none needed
	$(BIN)/harness cost shaders/brdf.glsl shade

trade: $(VENV)/.cost $(VENV)/.trade ## what each choice in the shading model costs and how wrong it is, to build/trade/
	$(BIN)/harness trade project.sprj -o build/trade

trade-readme: $(VENV)/.cost $(VENV)/.trade ## the same, and the README's table and docs/trade.json anew
	$(BIN)/harness trade project.sprj -o build/trade --readme README.md

lint: $(VENV)/.lint ## format and static checks
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/clang-format --dry-run -Werror harness/native/*.[ch] harness/native/cost/*.[ch] tests/native/*.[ch]

format: $(VENV)/.lint ## put the format right
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(BIN)/clang-format -i harness/native/*.[ch] harness/native/cost/*.[ch] tests/native/*.[ch]

build: $(VENV)/.harness ## the native library and the Python package

models: $(VENV)/.harness ## make models/*.glb again
	$(BIN)/python models/make_models.py

textures: $(VENV)/.harness ## make textures/*.png again
	$(BIN)/python textures/make_textures.py

extremes: $(VENV)/.harness ## measure docs/extremes.md, and draw its pictures again
	$(BIN)/python docs/make_extremes.py

clean: ## remove all that was built or installed here
	rm -rf build $(VENV) .pytest_cache .ruff_cache
	find . -name __pycache__ -prune -exec rm -rf {} +

# ---- What the commands need: each step leaves a file, and is done again only when what it depends on is newer --------

$(VENV)/.apt: setup/apt.sh
	@./setup/apt.sh
	@mkdir -p $(VENV) && touch $@

$(VENV)/bin/python: | $(VENV)/.apt
	$(PYTHON) -m venv $(VENV)

$(VENV)/.harness: pyproject.toml $(NATIVE) $(VENV)/.apt | $(VENV)/bin/python
	@echo "Building the native library, and installing the package into $(VENV) ..."
	@$(PIP) --editable .
	@touch $@

$(VENV)/.test: pyproject.toml setup/apt.sh | $(VENV)/.harness
	@./setup/apt.sh test
	$(call install_extra,test)

$(VENV)/.bench: pyproject.toml | $(VENV)/.test
	@./setup/apt.sh bench
	$(call install_extra,bench)

$(VENV)/.trade: pyproject.toml | $(VENV)/.harness
	$(call install_extra,trade)

# Built again with what is there now: the tests of costs run from then on, and are skipped before.
$(VENV)/.cost: | $(VENV)/.harness
	@./setup/apt.sh cost
	@$(PIP) --editable .
	@touch $@

$(VENV)/.lint: pyproject.toml | $(VENV)/bin/python
	$(call install_extra,lint)
