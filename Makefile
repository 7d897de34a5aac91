# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
#
# The commands of everyday work; HACKING.md tells more about each.
.DEFAULT_GOAL := help
JOBS ?= $(shell nproc)
SECONDS ?= 60
RELEASE = build/release/bin/kinemark

help:  ## these lines
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "make %-10s %s\n", $$1, $$2}' Makefile

demo: program  ## simulate a subject, find its joint angles, write a report, compare with the truth
	python3 tools/demo --program $(RELEASE) --out demo

program:  ## build the program alone: build/release/bin/kinemark
	tools/setup --demo
	cmake --preset release -DKINEMARK_DEVELOPER=OFF
	cmake --build --preset release --target kinemark --parallel $(JOBS)

release:  ## build the program, tests and benchmarks, optimised
	tools/setup
	cmake --preset release -DKINEMARK_DEVELOPER=ON
	cmake --build --preset release --parallel $(JOBS)

test:  ## everything that CI runs
	tools/setup
	python3 tools/run_tests.py --jobs $(JOBS)

accept: release  ## everything that CI runs within its budget, the acceptance table with its slow rows, clang-tidy on all
	python3 tools/run_tests.py --jobs $(JOBS) --check-budget
	python3 tools/run_tests.py --jobs $(JOBS) --only release-tests,fuzz-hunt,asan-program,asan-cli,threads-build,threads
	python3 tests/acceptance/run.py
	cmake --install build/release --prefix build/release/prefix
	cmake -S tests/consumer/headers -B build/release/headers -G Ninja -DEACH=ON -DCMAKE_PREFIX_PATH=$(CURDIR)/build/release/prefix
	cmake --build build/release/headers --parallel $(JOBS)
	cmake --preset tidy
	tools/check_tidy --all --jobs $(JOBS)

bench: release  ## speed and cost beside OpenSim and ezc3d, on the same files in one run
	tools/setup --oracles
	.venv/bin/python benchmarks/run.py --build build/release

fuzz:  ## fuzz the readers, SECONDS=60 each
	tools/setup
	cmake --preset asan
	cmake --build --preset asan --parallel $(JOBS)
	python3 tools/fuzz --seconds $(SECONDS)

lint:  ## clang-tidy on what changed, layers, licences, READMEs, layout
	tools/setup
	cmake --preset tidy
	tools/check_format
	tools/check_layers.py
	tools/check_public_headers.py
	tools/check_spdx.py
	tools/check_readmes.py
	tools/check_sentences.py
	tools/check_tidy --jobs $(JOBS)

docs:  ## API documentation of the public headers: build/release/docs/html/index.html
	tools/setup
	cmake --preset release -DKINEMARK_DEVELOPER=ON
	cmake --build --preset release --target docs

format:  ## lay out all C++ files
	tools/check_format --fix

clean:  ## remove what was built
	rm -rf build demo

.PHONY: help demo program release test accept bench fuzz lint docs format clean
