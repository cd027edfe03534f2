#!/usr/bin/env python3
"""Builds and runs programs against Toile as others would.

Usage: install_test.py OPTIONS package         what the build tree installs, found by find_package and by pkg-config
       install_test.py OPTIONS core            a shared library and nothing else, without Embree, libpng, CLI11, GoogleTest; and its program
       install_test.py OPTIONS subdirectory    a project that takes Toile in by add_subdirectory
"""
import argparse
import importlib.util
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

optional_packages = ["embree", "PNG", "TinyGLTF", "SQLite3", "CLI11", "GTest", "benchmark"]


class Failed(Exception):
    pass


def run(*words, cwd=None, env=None, expected=0):
    """What the command printed."""
    words = [str(word) for word in words]
    done = subprocess.run(words, cwd=cwd, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != expected:
        raise Failed(f"{shlex.join(words)}: exit {done.returncode}, expected {expected}\n{done.stdout[-6000:]}")
    return done.stdout


def expect(holds, words):
    if not holds:
        raise Failed(words)


def commands_of(build):
    return {entry["file"]: shlex.split(entry["command"]) for entry in json.loads((build / "compile_commands.json").read_text())}


def include_folders(words):
    """-I a, -Ia, -isystem a"""
    found = []
    for word, following in zip(words, words[1:] + [""]):
        if word in {"-I", "-isystem"}:
            found.append(following)
        elif word.startswith("-I"):
            found.append(word[2:])
    return found


class Others:
    def __init__(self, options, scratch):
        self.options, self.scratch = options, scratch
        self.cmake = options.cmake

    def configure(self, source, build, *settings):
        return run(self.cmake, "-S", source, "-B", build, "-G", self.options.generator, "-DCMAKE_BUILD_TYPE=Release",
                   f"-DCMAKE_CXX_COMPILER={self.options.compiler}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *settings)

    def build(self, build, *targets):
        run(self.cmake, "--build", build, "-j", "2", *(["--target", *targets] if targets else []))

    def install(self, build):
        """Installed in one place and moved to another: a package is made on one machine and used on another."""
        first, prefix = self.scratch / "installed", self.scratch / f"prefix_{build.name}"
        run(self.cmake, "--install", build, "--prefix", first)
        first.rename(prefix)
        found = {str(path.relative_to(prefix / "include")) for path in (prefix / "include").rglob("*") if path.is_file()}
        there = {f"toile/{path.name}" for path in (self.options.source / "include/toile").glob("*.hpp")}
        expect(found == there, f"include/ has {sorted(found)}, expected {sorted(there)}")
        return prefix

    def examples(self, prefix):
        """Builds all of them with no folder of headers but the prefix's, and runs them: {name: what it said}."""
        build = self.scratch / f"examples_{prefix.name}"
        self.configure(self.options.source / "examples", build, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        for file, words in commands_of(build).items():
            expect(include_folders(words) == [str(prefix / "include")], f"{file} is compiled with headers of {include_folders(words)}")
            expect("-std=c++20" in words or "-std=gnu++20" in words, f"{file}: not compiled as C++20: {words}")
            strange = [w for w in words if w.startswith(("-D", "-f")) and w != "-DNDEBUG"]
            expect(not strange, f"{file}: the package adds {strange}")
        self.build(build)
        folder = self.scratch / f"run_{prefix.name}"
        folder.mkdir()
        os.symlink(self.options.source / "patterns", folder / "patterns")
        sources = sorted((self.options.source / "examples").glob("*.cpp"))
        expect(sources, "no example is there")
        said = {source.stem: run(build / source.stem, cwd=folder) for source in sources}
        expect(said["version"] == f"toile {self.options.version}\n", f"version says {said['version']!r}")
        print(f"ran {len(said)} examples")
        return said

    def pkg_config(self, prefix):
        if shutil.which("pkg-config") is None:
            print("no pkg-config here: toile.pc not tried")
            return
        folder = next(prefix.rglob("toile.pc")).parent
        env = {**os.environ, "PKG_CONFIG_PATH": str(folder)}
        expect(run("pkg-config", "--modversion", "toile", env=env).strip() == self.options.version, "toile.pc has another version")
        flags = run("pkg-config", "--cflags", "--libs", "--static", "toile", env=env).split()
        program = self.scratch / "by_pkg_config"
        run(self.options.compiler, "-std=c++20", self.options.source / "examples/version.cpp", *flags, "-o", program)
        expect(run(program) == f"toile {self.options.version}\n", "the program made with toile.pc says something else")

    def refuses_other_versions(self, prefix):
        """Below 1.0 a minor version may change what is public, and an earlier one is another."""
        major, minor, _ = self.options.version.split(".")
        earlier_fits = int(major) > 0
        folder = self.scratch / "asks"
        folder.mkdir()
        asked_of = [(f"{major}.{minor}", True), (f"{major}.{int(minor) + 1}", False), (f"{int(major) + 1}", False)]
        if int(minor) > 0:
            asked_of.append((f"{major}.{int(minor) - 1}", earlier_fits))
        for asked, fits in asked_of:
            (folder / "CMakeLists.txt").write_text(
                f"cmake_minimum_required(VERSION 3.16)\nproject(asks LANGUAGES CXX)\nfind_package(toile {asked})\n"
                f"if(NOT toile_FOUND STREQUAL \"{int(fits)}\")\n  message(FATAL_ERROR \"toile {asked}: found ${{toile_FOUND}}\")\nendif()\n")
            self.configure(folder, self.scratch / f"asks_{asked}", f"-DCMAKE_PREFIX_PATH={prefix}")

    def package(self):
        prefix = self.install(self.options.build)
        config = next(prefix.rglob("toileConfig.cmake")).read_text()
        draws = "set(toile_PICTURES TRUE)" in config
        for package in ("TBB", "fmt", "hwy", "yaml-cpp"):
            expect(f"find_dependency({package})" in config, f"toileConfig.cmake does not look for {package}:\n{config}")
        expect(draws == ("find_dependency(PNG)" in config) == ("find_dependency(embree" in config), f"pictures, or not?\n{config}")
        for package in ("Eigen3", "nlohmann_json", "CLI11", "GTest", "benchmark"):
            expect(package not in config, f"toileConfig.cmake looks for {package}, which nobody needs:\n{config}")
        self.examples(prefix)
        self.pkg_config(prefix)
        self.refuses_other_versions(prefix)
        said = run(prefix / "bin/toile", "--version").strip()
        expect(said == self.options.version, f"the installed program is version {said}")

    def core(self):
        work, source = self.options.work, self.options.source
        alone = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in optional_packages]
        # The flags of the build that runs the tests.
        told = self.configure(source, work, *alone, "-DBUILD_SHARED_LIBS=ON", "-DTOILE_WERROR=ON", "-DTOILE_UNITY=ON", "-DTOILE_CLI=AUTO", "-DTOILE_PYTHON=OFF")
        for line in ("Toile: the program `toile`: no: needs CLI11", "Toile: pictures: no: needs Embree 3 or 4 and libpng", "Toile: glTF files: no: needs tinygltf",
                     "Toile: tests: no: needs GoogleTest"):
            expect(line in told, f"the configuration does not say '{line}':\n{told}")
        self.build(work)
        library = next((work / "lib").glob("libtoile.so"))
        run(sys.executable, source / "tools/public_symbols.py", "--check", source / "tests/api/symbols.txt", library)
        needed = run("readelf", "--dynamic", library)
        expect(not re.search(r"NEEDED.*(embree|png)", needed), f"libtoile.so needs libraries for pictures:\n{needed}")
        prefix = self.install(work)
        expect(not (prefix / "bin").exists(), "a program was installed")
        config = next(prefix.rglob("toileConfig.cmake")).read_text()
        expect("find_dependency(" not in config, "a shared library asks its users for libraries:\n" + config)
        expect("set(toile_PICTURES FALSE)" in config, "toileConfig.cmake does not say that there are no pictures:\n" + config)
        shared, static = self.examples(prefix), self.examples(self.install(self.options.build))
        expect(re.search(r"\b[0-9a-f]{16}\b", shared["checkpoint"]), f"no hash of a state: {shared['checkpoint']}")
        for name, said in shared.items():
            expect(said == static[name], f"{name}: a shared libtoile says\n{said}and a static one\n{static[name]}")
        asks = self.scratch / "asks_for_a_picture"
        lib = next(prefix.rglob("libtoile.so")).parent
        run(self.options.compiler, "-std=c++20", "-I", prefix / "include", source / "tests/install/no_pictures.cpp", "-L", lib, "-ltoile",
            f"-Wl,-rpath,{lib}", "-o", asks)
        expect("built without pictures" in run(asks), "asked for a picture, the library says something else")
        self.program_without_pictures(work)

    def program_without_pictures(self, work):
        self.configure(self.options.source, work, "-DCMAKE_DISABLE_FIND_PACKAGE_CLI11=OFF", "-DTOILE_CLI=ON")
        self.build(work, "toile")
        toile, folder = work / "toile", self.scratch / "toile"
        folder.mkdir()
        # Unasked, it goes without; asked, it refuses before anything else is done.
        said = run(toile, "demo", "cylinder", "--resolution", "8", "--seconds", "0.1", "--out", "out", cwd=folder)
        expect("built without pictures" in said, f"demo says nothing of pictures:\n{said}")
        expect((folder / "out/report.json").exists() and not (folder / "out/preview.png").exists(), "the demo's folder is not as it should be")
        scene = json.loads((self.options.source / "scenes/cylinder.json").read_text())
        scene["output"] = {"preview": True}
        (folder / "scene.json").write_text(json.dumps(scene))
        for words in (["preview", "out"], ["verify", "out", "--picture"], ["run", "scene.json", "--out", "second"]):
            said = run(toile, *words, cwd=folder, expected=2)
            expect("built without pictures" in said and said.count("\n") == 1, f"{words}: {said}")
        expect(not (folder / "second").exists(), "a run was begun that cannot end as asked for")

    def subdirectory(self):
        work, source = self.options.work, self.options.source
        spec = importlib.util.spec_from_file_location("compile_flags", source / "tests/install/compile_flags_test.py")
        flags = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(flags)

        def configure(build, *more):
            self.configure(source / "tests/install/parent", build, f"-DTOILE_SOURCE={source}", *more)
            commands = commands_of(build)
            app = commands.pop(str(source / "examples/version.cpp"))
            expect("-DPARENT=1" in app, f"the parent's own flags are gone: {app}")
            ours = [w for w in app if w.startswith(("-W", "-DEIGEN", "-DTOILE", "-ffp", "-fno-fast", "-fvis"))]
            expect(not ours, f"flags of ours have come to the parent: {ours}")
            expect(include_folders(app) == [str(source / "include")], f"the parent sees headers of {include_folders(app)}")
            expect(len(commands) > (30 if "-DTOILE_UNITY=ON" in more else 200), f"only {len(commands)} sources of ours")
            for file, words in commands.items():
                found = list(flags.breaks_of({"command": shlex.join(words)}))
                expect(not found, f"{file}: {found}")
            return commands

        for file, words in configure(self.scratch / "fast", "-DCMAKE_CXX_FLAGS=-ffast-math").items():
            expect("-Werror" not in words, f"{file}: a parent's compiler may warn of what ours does not")
        configure(work, "-DTOILE_WERROR=ON", "-DTOILE_UNITY=ON")  # the flags of the build that runs the tests
        self.build(work, "app")
        expect(run(work / "app") == f"toile {self.options.version}\n", "the parent's program says something else")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("source", "build", "work"):
        parser.add_argument(f"--{name}", type=pathlib.Path)
    for name in ("version", "generator", "compiler", "cmake"):
        parser.add_argument(f"--{name}")
    parser.add_argument("what", choices=["package", "core", "subdirectory"])
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="toile_install_") as folder:
        others = Others(options, pathlib.Path(folder).resolve())
        try:
            getattr(others, options.what)()
        except Failed as failure:
            print(failure)
            return 1
    print(f"{options.what}: as others would")
    return 0


if __name__ == "__main__":
    sys.exit(main())
