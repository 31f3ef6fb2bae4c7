# The commands of the project; CI runs the same ones.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo test lint bench reference styles gallery clean

demo: $(STAMP)
	$(BIN)/vdsc compile examples/coffee.vds

test: $(STAMP)
	$(BIN)/pytest -n 2 --dist loadfile --no-loadscope-reorder --durations 25  # in the order of tests/conftest.py

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: $(STAMP)
	$(BIN)/vdsc bench

# The pages of docs/library, with their pictures, from the library itself.
reference: $(STAMP)
	$(BIN)/python -m vdsl.pipeline.reference docs/library

# The pages of docs/styles, with a strip of every camera style.
styles: $(STAMP)
	$(BIN)/python -m vdsl.pipeline.catalogue docs/styles

# The looked-at pictures of docs/gallery: every set by day and by night in the looks, and hard cases.
gallery: $(STAMP)
	$(BIN)/python -m vdsl.pipeline.gallery docs/gallery

# torch goes first and pinned: asked for by another package, PyPI's newest build
# brings several gigabytes of CUDA along.
$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet -c constraints.txt torch
	$(BIN)/pip install --quiet -c constraints.txt -e '.[dev]'
	touch $@

clean:
	rm -rf build dist
