# Everything a user types. Each target installs and builds what it needs first; with nothing to do that takes no time.

.DEFAULT_GOAL := help
.PHONY: docs pictures urdf help setup build demo film test test-slow test-long test-all bench soak faults lint format clean

# Tests to run: parts of their paths or names (make test TESTS="lights walk"). SEED: their random order.
TESTS ?=
SEED ?=
# Options of `make soak`; see test/soak/run.py --help.
SOAK ?=

help: ## Show this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1|\2/p' Makefile | awk -F'|' '{ printf "%-18s%s\n", $$1, $$2 }'

setup: ## Install the missing Debian packages and the virtual environment .venv
	@scripts/setup

build: setup ## Build the catkin workspace .ws
	@scripts/build

demo: ## Play the demonstration in the simulator; pictures, sound and a table in demo_output, in place of the last ones
	@scripts/setup --minimal
	@scripts/build
	@scripts/ros-env python3 nao_library_modules/examples/demo.py --output demo_output --overwrite

film: ## Film the ten behaviours that are bundled; behaviors.mp4 and a sheet of pictures in demo_output
	@scripts/setup --minimal
	@scripts/build
	@scripts/ros-env python3 nao_library_modules/examples/film_behaviors.py --output demo_output --overwrite

test: build ## Run the tests of the levels logic, robot and ros; closes with "N passed, N failed" (TESTS="lights walk")
	@scripts/test test $(TESTS)

test-slow: build ## Run the level slow in its short form: examples, commands of the documents, several robots, parts of long tables
	@scripts/test slow $(TESTS)

test-long: build ## Run the level slow in its long form: all animations, all rows of its tables, a bare Debian
	@scripts/test long $(TESTS)

test-all: build ## Run all levels in their long form, in random order (SEED=1: in the order of that seed)
	@SEED="$(SEED)" scripts/test all $(TESTS)

bench: build ## Print the benchmarks: ratios measured side by side
	@scripts/ros-env python3 test/benchmarks/run.py

soak: build ## Half an hour of random goals on two machines, with accidents; report in soak_output (SOAK="--minutes 5")
	@scripts/ros-env python3 test/soak/run.py $(SOAK)

faults: build ## Apply faults one by one and see which test notices each (FAULTS="lights odometry"); test/faults/README.md
	@.venv/bin/python test/faults/run.py $(FAULTS)

lint: setup ## Check the form of Python files, packages and scripts
	@scripts/lint

format: setup ## Put the form of Python files right
	@.venv/bin/ruff check --fix --quiet . ; .venv/bin/ruff format .

urdf: setup ## Generate the robot's URDF anew from its tables
	@PYTHONPATH=nao_sim_bridge/src .venv/bin/python nao_sim_bridge/nodes/nao_urdf \
	    --output nao_sim_bridge/urdf/nao_h25.urdf --meshes nao_sim_bridge/urdf/meshes

docs: build ## Write the tables of README.md and docs/ anew from the code
	@scripts/ros-env python3 scripts/readme_tables.py

pictures: build ## Draw the pictures of README.md and docs/ anew; needs the Debian package graphviz as well
	@PYTHONPATH=nao_sim_bridge/src:nao_library_modules/src .venv/bin/python scripts/readme_pictures.py
	@scripts/ros-env python3 scripts/readme_behaviors.py

clean: ## Remove the workspace and the virtual environment; what demo and soak have written stays
	rm -rf .ws .venv
