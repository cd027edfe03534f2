# The commands of the README.  Everything real happens in CMake; this file only says what is run.
.PHONY: configure build demo test test-golden test-clang test-sanitizers test-long bench settings tidy format symbols clean packages python-environment api-reference blender-addon test-blender
JOBS ?= $(shell nproc)

# Prerequisites one after the other, with -j too: `packages` comes before what needs them.
.NOTPARALLEL:

# Where it fails, what is missing is named.  Nothing is installed by `make build`.
configure:
	@cmake --preset release >/dev/null || { tools/install_packages.sh --check; exit 1; }

build: configure
	@cmake --build --preset release -j $(JOBS)

# `demo` and `test` also set up a fresh machine.  Without the tests, which are nearly half of what there is to build.
demo: packages configure
	@cmake --build --preset release --target toile -j $(JOBS)
	build/release/toile demo

# And the program by clang, its hashes and its lower modules.
test: packages python-environment build test-golden
	ctest --preset release -LE long -j $(JOBS)

# The scenes whose last state is known to the bit, and the modules whose arithmetic everything else rests on, by clang.
clang_modules := core material constraint assembly solver golden
test-golden: packages
	@cmake --preset clang >/dev/null
	@cmake --build --preset clang --target toile $(clang_modules:%=toile_test_%) -j $(JOBS)
	ctest --preset clang -LE long -R '$(call any_of,$(clang_modules))' -j $(JOBS)

test-clang: packages
	@cmake --preset clang >/dev/null
	@cmake --build --preset clang -j $(JOBS)
	ctest --preset clang -LE long -j $(JOBS)

# With little optimisation too: by g++ for addresses and undefined behaviour, by clang for threads.
all_modules := core mesh io material constraint contact assembly solver step garment body dress verify preview sim golden
threaded_modules := core contact assembly solver step golden
test-sanitizers: packages
	@cmake --preset dev >/dev/null
	@cmake --build --preset dev --target $(all_modules:%=toile_test_%) -j $(JOBS)
	ctest --preset dev -LE long -R '$(call any_of,$(all_modules))' -j $(JOBS)
	@cmake --preset tsan >/dev/null
	@cmake --build --preset tsan --target $(threaded_modules:%=toile_test_%) -j $(JOBS)
	ctest --preset tsan -LE long -R '$(call any_of,$(threaded_modules))' -j $(JOBS)

# core mesh -> ^(core|mesh)[.]        a regular expression for the names of their tests
empty :=
any_of = ^($(subst $(empty) $(empty),|,$(strip $(1))))[.]

test-long: build
	ctest --preset release -L long

bench: build
	build/release/bench/toile_bench

# Schema and tables of docs/, from the descriptions of the settings.
settings: configure
	@cmake --build --preset release --target settings -j $(JOBS)

# The list of what libtoile shows, after a change of include/toile.
symbols: configure
	@cmake --build --preset release --target toile_library -j $(JOBS)
	tools/public_symbols.py --write tests/api/symbols.txt build/release/lib/libtoile.a

# docs/api.md, after a change of include/toile or of a docstring.
api-reference:
	tools/api_reference.py

# These need clang's tools, which `packages` does not install.
tidy: build
	tools/run_clang_tidy.sh
format:
	tools/format.sh

# What the Python module is built and tested with, from PyPI; without a registry within reach the module is left out.
python-environment: packages
	@tools/python_environment.sh build/release

# The add-on for Blender as a zip file, with the program of this build.
blender-addon: configure
	@cmake --build --preset release --target blender_addon -j $(JOBS)

# In a real Blender: Debian's, about 400 MB with what it needs, where there is none.
test-blender: build
	@command -v blender >/dev/null || [ -n "$$TOILE_BLENDER" ] || tools/install_packages.sh --blender
	ctest --preset release -R '^blender_' --output-on-failure

packages:
	@tools/install_packages.sh

clean:
	rm -rf build
