# Two commands matter: `make demo` shows what fddbench does, `make test` checks it.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: demo test test-slow lint wheel lowest scores findings comparison schemas bench clean

demo: $(VENV)/ready
	$(BIN)/fddbench run campaigns/smoke.yaml --fresh
	$(BIN)/fddbench report results/smoke
	$(BIN)/fddbench run campaigns/smoke_6dof.yaml --fresh
	$(BIN)/fddbench report results/smoke_6dof

test: $(VENV)/ready-dev lint
	$(BIN)/python -m pytest -n auto --dist worksteal -m "not slow"

# what takes minutes or needs a browser and compilers
test-slow: $(VENV)/ready-dev
	bash .ci/tools
	$(BIN)/python -m pytest -n auto --dist worksteal -m slow

lint: $(VENV)/ready-dev
	$(BIN)/ruff format --check src tests detectors
	$(BIN)/ruff check src tests detectors
	$(BIN)/lint-imports
	$(BIN)/mypy

# the wheel, in an empty environment, from a folder outside the repository
wheel:
	bash .ci/wheel

# the lowest versions of pyproject.toml: a campaign, its page and a design
lowest:
	bash .ci/lowest

# our scores, kept under version control; read the difference before you commit it
scores: $(VENV)/ready
	for name in smoke yaw_rate_table8 jet_engine_monte_carlo b747_monte_carlo b747_trim fes_monte_carlo; do \
	  $(BIN)/fddbench run campaigns/$$name.yaml --fresh --quiet && mkdir -p reports/$$name \
	  && $(BIN)/fddbench scores results/$$name > reports/$$name/scores.yaml || exit 1; done

# what the campaigns that compare detectors found, in ten lines each, written from their rows
findings: $(VENV)/ready
	for path in campaigns/yaw_rate_*.yaml campaigns/*_engine_comparison.yaml campaigns/b747_comparison.yaml; do name=$$(basename $$path .yaml); \
	  grep -q '^purpose: tuning' $$path && continue; \
	  $(BIN)/fddbench run $$path --fresh --quiet; mkdir -p reports/$$name \
	  && $(BIN)/fddbench finding results/$$name > reports/$$name/finding.md || exit 1; done

# the designs of yaw_rate_comparison: every detector tuned on the same flights, to the same false alarms, in the same way
comparison: $(VENV)/ready
	for design in $$(sed -n 's/^  - \([a-z_0-9]*\)$$/\1/p' campaigns/yaw_rate_comparison_tuning.yaml); do \
	  $(BIN)/fddbench tune $$design yaw_rate_comparison_tuning --false-alarm-rate 0.01 --by factor \
	    --output detectors/$${design}_compared.yaml --force || exit 1; done

# the schemas that the campaigns name to an editor; after a new name, range or key
schemas: $(VENV)/ready
	for path in campaigns/schema/*.json; do name=$$(basename $$path .json); \
	  $(BIN)/fddbench schema $$name --output campaigns/schema/$$name.json || exit 1; done

# the documentation as a site in site/, without a network; a test builds it too
docs: $(VENV)/ready-docs
	NO_MKDOCS_2_WARNING=1 DISABLE_MKDOCS_2_WARNING=true $(BIN)/mkdocs build --quiet

$(VENV)/ready-docs: $(VENV)/ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[docs]"
	touch $@

# how fast the engine is beside others, on a machine that does nothing else
bench: $(VENV)/ready-bench
	$(BIN)/python -m tests.bench

$(VENV)/ready: pyproject.toml
	$(PYTHON) -c "import sys; sys.exit(None if sys.version_info >= (3, 11) else 'fddbench needs Python 3.11 or newer: make PYTHON=python3.12 ...')"
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e .
	touch $@

$(VENV)/ready-dev: $(VENV)/ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[dev]"
	touch $@

# peers that have no wheel for this machine are skipped with a word
$(VENV)/ready-bench: $(VENV)/ready
	for peer in control heyoka jax jsbsim; do \
	  $(BIN)/python -m pip install --quiet --disable-pip-version-check --only-binary :all: $$peer || true; done
	touch $@

clean:
	rm -rf $(VENV) results dist build site .mypy_cache .ruff_cache .pytest_cache .hypothesis
