# The commands of the README.  Everything real happens in CMake; this file only says what is run.
.PHONY: build demo test test-long bench tidy format clean packages
JOBS ?= $(shell nproc)

build: packages
	@cmake --preset release >/dev/null
	@cmake --build --preset release -j $(JOBS)

demo: build
	build/release/toile demo

test: build
	ctest --preset release -LE long -j $(JOBS)

test-long: build
	ctest --preset release -L long

bench: build
	build/release/bench/toile_bench

# These need clang's tools, which `packages` does not install.
tidy: build
	tools/run_clang_tidy.sh
format:
	tools/format.sh

packages:
	@tools/install_packages.sh

clean:
	rm -rf build
