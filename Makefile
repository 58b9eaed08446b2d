# Everything a user types. Each target installs and builds what it needs first; with nothing to do that takes no time.

.DEFAULT_GOAL := help
.PHONY: docs pictures urdf help setup build demo test unit rostest bench soak lint format clean

# Tests for `make unit` and `make rostest`: parts of their names (TESTS="lights walk"). Scenarios at once: JOBS=2.
TESTS ?=
JOBS ?= 1
# Options of `make soak`; see test/soak/run.py --help.
SOAK ?=

help: ## Show this list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  make \1|\2/p' Makefile | awk -F'|' '{ printf "%-16s%s\n", $$1, $$2 }'

setup: ## Install the missing Debian packages and the virtual environment .venv
	@scripts/setup

build: setup ## Build the catkin workspace .ws
	@scripts/build

demo: build ## Play the demonstration in the simulator; pictures, sound and a table in demo_output
	@scripts/ros-env python3 nao_library_modules/examples/demo.py --output demo_output

test: build ## Run all tests; closes with "N passed, N failed" (JOBS=2: two scenarios at once)
	@scripts/test all --jobs $(JOBS)

unit: setup ## Run the unit tests: no ROS master, and no build unless they use messages (TESTS="lights walk")
	@scripts/test unit $(TESTS)

rostest: build ## Run the ROS scenarios (TESTS="lights walk": some of them; JOBS=2: two at once)
	@scripts/test rostest --jobs $(JOBS) $(TESTS)

bench: build ## Print the benchmarks: ratios measured side by side
	@scripts/ros-env python3 test/benchmarks/run.py

soak: build ## Half an hour of random goals on two machines, with accidents; report in soak_output (SOAK="--minutes 5")
	@scripts/ros-env python3 test/soak/run.py $(SOAK)

lint: setup ## Check the form of Python files, packages and scripts
	@scripts/lint

format: setup ## Put the form of Python files right
	@.venv/bin/ruff check --fix --quiet . ; .venv/bin/ruff format .

urdf: setup ## Generate the robot's URDF anew from its tables
	@PYTHONPATH=nao_sim_bridge/src .venv/bin/python nao_sim_bridge/nodes/nao_urdf \
	    --output nao_sim_bridge/urdf/nao_h25.urdf --meshes nao_sim_bridge/urdf/meshes

docs: build ## Write the tables of README.md anew from the code
	@scripts/ros-env python3 scripts/readme_tables.py

pictures: build ## Draw the pictures of README.md anew
	@PYTHONPATH=nao_sim_bridge/src:nao_library_modules/src .venv/bin/python scripts/readme_pictures.py
	@scripts/ros-env python3 scripts/readme_behaviors.py

clean: ## Remove the workspace, the virtual environment and what the demonstration left
	rm -rf .ws .venv demo_output soak_output
