# make view   set everything up and open the viewer on a demo scene; without a screen, render it into out/
# make test   set everything up and run all tests
# make docs   make the parameter tables and the pictures of docs/ anew
# make lint   ruff and mypy

# The first Python on the path that runs and is new enough.
PYTHON ?= $(shell for name in python3 python python3.11 python3.12 python3.13 python3.14; do \
	$$name -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$name && break; done)
VENV := .venv
BIN := $(VENV)/$(if $(filter Windows_NT,$(OS)),Scripts,bin)
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check

GL_PACKAGES := libgl1 libegl1 libgl1-mesa-dri libopengl0
WINDOW_PACKAGES := libx11-6 libxcursor1 libxi6 libxinerama1 libxrandr2 libxkbcommon0

# One place that installs with apt: does nothing, and never fails, where there is no apt or no right to use it.
apt = if [ -n "$(strip $(1))" ] && command -v apt-get >/dev/null; then \
	root=$$([ "$$(id -u)" = 0 ] || echo "sudo -n"); \
	echo "installing with apt: $(strip $(1))"; \
	export DEBIAN_FRONTEND=noninteractive; \
	{ $$root apt-get -qq -o Acquire::http::Timeout=20 update && \
	  $$root apt-get -qq -y --no-install-recommends install $(1); } >/dev/null 2>&1 || \
	echo "note: apt could not install these; going on without"; \
	fi

.PHONY: view test docs lint clean
.DEFAULT_GOAL := view

view: $(VENV)/screen
	@status=4; \
	if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] || [ "$$(uname)" != Linux ]; then $(BIN)/dofview; status=$$?; fi; \
	if [ $$status = 4 ]; then \
	echo "There is no screen for a window: rendering the demo scene with every method into out/ instead."; \
	$(BIN)/dofview compare --out out; \
	else exit $$status; fi

test: $(VENV)/screen
	@$(BIN)/python -m pytest

docs: $(VENV)/packages
	@$(BIN)/python docs/parameters.py && $(BIN)/python docs/actions.py && $(BIN)/python docs/pictures.py && $(BIN)/python docs/comparisons.py

lint: $(VENV)/packages
	@$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/mypy

clean:
	@rm -rf $(VENV) build dist out

$(VENV)/packages: pyproject.toml
	@[ -n "$(PYTHON)" ] || { echo "dofview needs Python 3.11 or newer: run make with PYTHON=/path/to/python3.11"; exit 1; }
	@"$(PYTHON)" -c 'import ensurepip' 2>/dev/null || { $(call apt,python3-venv); }
	@echo "setting up $(VENV)"
	@"$(PYTHON)" -m venv $(VENV)
	@$(PIP) install --editable '.[test]'
	@touch $@

$(VENV)/screen: $(VENV)/packages
	@if [ "$$(uname)" = Linux ]; then \
	packages=""; \
	$(BIN)/dofview doctor >/dev/null 2>&1 || packages="$(GL_PACKAGES)"; \
	command -v Xvfb >/dev/null || packages="$$packages xvfb $(WINDOW_PACKAGES)"; \
	command -v xdotool >/dev/null || packages="$$packages xdotool"; \
	command -v glslangValidator >/dev/null || packages="$$packages glslang-tools"; \
	if [ -n "$$packages" ]; then $(call apt,$$packages); fi; \
	fi
	@$(BIN)/dofview doctor >/dev/null || true
	@touch $@
