# The commands of the README.  Everything real happens in CMake; this file only says what is run.
.PHONY: configure build demo test test-long bench settings tidy format clean packages
JOBS ?= $(shell nproc)

configure: packages
	@cmake --preset release >/dev/null

build: configure
	@cmake --build --preset release -j $(JOBS)

# Without the tests, which are nearly half of what there is to build.
demo: configure
	@cmake --build --preset release --target toile -j $(JOBS)
	build/release/toile demo

test: build
	ctest --preset release -LE long -j $(JOBS)

test-long: build
	ctest --preset release -L long

bench: build
	build/release/bench/toile_bench

# Schema and tables of docs/, from the descriptions of the settings.
settings: configure
	@cmake --build --preset release --target settings -j $(JOBS)

# These need clang's tools, which `packages` does not install.
tidy: build
	tools/run_clang_tidy.sh
format:
	tools/format.sh

packages:
	@tools/install_packages.sh

clean:
	rm -rf build
