# What continuous integration checks, part by part; `make all` is everything but `oldest`.
export EXUDYN_NO_USER_SETTINGS = 1
export MPLBACKEND = Agg
PYTHON ?= python3
OLDEST ?= .oldest

SITE ?= site

.PHONY: all style types site test quick kernels wheel oldest

all: style types site test

style:
	ruff check .
	ruff format --check .

types:
	mypy
	mypy --strict --follow-imports=silent tests/typed_program.py

# Needs the extra [docs]; open $(SITE)/index.html.
site:
	sphinx-build -W --keep-going -q -b html docs $(SITE)

test:
	pytest --durations=15

quick:
	pytest -m "not slow"

kernels:
	pytest tests/test_kernels_without_compiler.py

wheel:
	pytest tests/test_from_the_wheel.py

# Continuous integration has no time for the whole suite twice: what reaches the compiler, the
# files and Exudyn.
oldest:
	$(PYTHON) -m venv $(OLDEST)
	$(OLDEST)/bin/pip install --quiet -r requirements/oldest.txt -e '.[test]'
	$(OLDEST)/bin/python -m pytest tests/test_table2_of_the_paper.py tests/test_vehicle_files.py \
	    tests/test_creep_own_law.py tests/test_simulate.py
