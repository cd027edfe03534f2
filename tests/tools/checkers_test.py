"""The checks of the project, each against a small tree with one mistake planted in it.

Usage: checkers_test.py FOLDER_OF_TOOLS
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

tools = pathlib.Path(sys.argv.pop(1)).resolve()
compiler = shutil.which(os.environ.get("CXX", "c++"))

sound_tree = {
    "src/layers.txt": "# lowest first\ncore\nmesh\nio material\n",
    "src/CMakeLists.txt": "toile_module(core LIBRARIES TBB::tbb)\ntoile_module(mesh DEPENDS core)\n"
                          "toile_module(io DEPENDS mesh)\ntoile_module(material DEPENDS core)\n",
    "src/core/types.hpp": "// docs/units.md#length\n",
    "src/mesh/mesh.hpp": '#include "core/types.hpp"\n#include "mesh/mesh.hpp"\n#include <vector>\n',
    "src/io/obj.cpp": '#include "core/types.hpp"\n#include "mesh/mesh.hpp"\nconstexpr double gap_m = 1e-3;\n',
    "tests/mesh/mesh_test.cpp": "TEST(Mesh, IsOne) {}\n",
    "docs/units.md": "# Units\n\n## Length\n\nSee [home](../README.md#toile), `src/core/types.hpp`, `src/{io,mesh}/*.*pp`, "
                     "`Mesh.IsOne`, `gap_m = 0.001` and units.md.\n",
    "README.md": "# Toile\n\n[units](docs/units.md#length)\n\n```sh\nmake build   # comment\n"
                 "build/release/toile check shirt.json\nbuild/release/toile check \\\n    bad.json   # exit 3\n"
                 "build/release/toile dress PATTERN\nbuild/release/toile check ../elsewhere/body.obj\n```\n\n"
                 "```sh long\nbuild/release/toile demo\n```\n",
    "Makefile": "JOBS := 2\nbuild:\n\techo\n",
    "shirt.json": "{}",
    "bad.json": "{}",
    # Stands for the program: 3 for a bad file, 5 for a demo, 0 otherwise.
    "build/release/toile": '#!/bin/sh\ncase "$*" in *bad*) exit 3;; *demo*) exit 5;; esac\nmkdir -p out && touch out/trace\n',
}


class Checkers(unittest.TestCase):
    def run_tool(self, tool, planted=None, arguments=()):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {**sound_tree, **(planted or {})}.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            (root / "build/release/toile").chmod(0o755)
            command = [sys.executable, str(tools / tool)]
            command += ["--root", folder, *arguments] if tool == "run_docs_commands.py" else [folder]
            result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            self.assertFalse((root / "out").exists(), "a document's command wrote into the source tree")
            return result.returncode, result.stdout

    def accepts(self, tool, planted=None, arguments=()):
        code, text = self.run_tool(tool, planted, arguments)
        self.assertEqual(code, 0, text)
        return text

    def refuses(self, tool, planted, words, arguments=()):
        code, text = self.run_tool(tool, planted, arguments)
        self.assertEqual(code, 1, text)
        self.assertIn(words, text)

    def test_a_sound_tree_passes(self):
        for tool in ("check_layers.py", "check_elementary.py", "check_docs.py", "run_docs_commands.py"):
            self.accepts(tool)

    def test_layers(self):
        tool = "check_layers.py"
        self.refuses(tool, {"src/core/a.cpp": '\n#include "mesh/mesh.hpp"\n'}, "src/core/a.cpp:2: 'core' may not include 'mesh'")
        self.refuses(tool, {"src/material/a.cpp": '#include "io/obj.hpp"\n'}, "'material' may not include 'io'")
        self.refuses(tool, {"src/material/a.cpp": '#include "mesh/mesh.hpp"\n'}, "does not link it")
        self.refuses(tool, {"src/material/a.cpp": '#include "util/a.hpp"\n'}, "unknown module 'util'")
        self.refuses(tool, {"src/util/a.cpp": "\n"}, "module 'util' is not in src/layers.txt")

    def check_headers(self, headers):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in headers.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            command = [sys.executable, str(tools / "check_public_headers.py"), folder, compiler]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            return result.returncode, result.stdout

    @unittest.skipIf(compiler is None, "there is no compiler in CXX or as c++")
    def test_public_headers(self):
        a, b = "include/toile/a.hpp", "include/toile/b.hpp"
        sound = {a: "#pragma once\n#include <vector>\n\nstd::vector<int> many();\n",
                 b: '#pragma once\n#include "toile/a.hpp"  // many\ninline std::vector<int> more() { return many(); }\n'}
        code, text = self.check_headers(sound)
        self.assertEqual(code, 0, text)
        pragma = "#pragma once\n"
        for planted, words in [
                ({a: pragma + "#include <Eigen/Core>\n"}, "a.hpp:2: #include <Eigen/Core>: only the standard library"),
                ({a: pragma + "#include <png.h>\n"}, "#include <png.h>: only"),
                ({a: pragma + '#include "core/types.hpp"\n'}, "only the standard library"),
                ({a: pragma + "std::vector<int> many();\n"}, "a.hpp: does not compile alone"),
                ({a: "#include <vector>\nstruct Twice {};\n"}, "does not compile alone"),
                ({a: pragma + "inline int f(int unused) { return 1; }\n"}, "does not compile alone"),
                ({"include/toile/sub/c.hpp": pragma}, "public headers are include/toile/*.hpp"),
                ({f"include/toile/n{i}.hpp": pragma for i in range(9)}, "11 headers, at most 10")]:
            code, text = self.check_headers({**sound, **planted})
            self.assertEqual(code, 1, planted)
            self.assertIn(words, text)

    @unittest.skipIf(compiler is None, "there is no compiler in CXX or as c++")
    def test_public_symbols(self):
        source = ("#define OPEN __attribute__((visibility(\"default\")))\n"
                  "namespace toile { OPEN int area(int x) { return x; } class OPEN Cloth { public: virtual ~Cloth(); }; Cloth::~Cloth() {}\n"
                  "namespace { int own() { return 1; } } inline int in_header() { return 2; }\n"
                  "namespace internal { int hidden() { return own() + in_header(); } } }\n")
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            listed = root / "symbols.txt"

            def library(text, *words):
                (root / "a.cpp").write_text(text)
                shared = root / "liba.so"
                subprocess.run([compiler, "-shared", "-fPIC", "-O1", *words, str(root / "a.cpp"), "-o", str(shared)], check=True)
                return shared

            def symbols(*words):
                command = [sys.executable, str(tools / "public_symbols.py"), *map(str, words)]
                result = subprocess.run(command, capture_output=True, text=True, check=False)
                return result.returncode, result.stdout

            hidden = library(source, "-fvisibility=hidden")
            self.assertEqual(symbols("--write", listed, hidden), (0, ""))
            names = listed.read_text().splitlines()
            self.assertEqual(names, sorted(names))
            self.assertIn("toile::area(int)", names)
            self.assertIn("toile::Cloth::~Cloth()", names)
            self.assertEqual(len(names), 2, names)
            self.assertEqual(symbols("--check", listed, hidden)[0], 0)
            # Everything visible: of the internal namespace, and of nobody's.
            code, text = symbols("--check", listed, library(source))
            self.assertEqual(code, 1)
            self.assertIn("exports what is not public: toile::internal::hidden()", text)
            code, text = symbols("--check", listed, library(source.replace("area(int x)", "area(long x)"), "-fvisibility=hidden"))
            self.assertEqual(code, 1)
            self.assertIn("shown and not listed: toile::area(long)", text)
            self.assertIn("listed and not shown: toile::area(int)", text)
            self.assertEqual(symbols("--check", listed, library("namespace toile { int f() { return 1; } }", "-fvisibility=hidden"))[0], 1)

    def test_public_headers_are_for_the_highest_module(self):
        tool = "check_layers.py"
        tree = {"src/layers.txt": sound_tree["src/layers.txt"] + "api\n",
                "src/CMakeLists.txt": sound_tree["src/CMakeLists.txt"] + "toile_module(api DEPENDS io)\n",
                "src/api/a.cpp": '#include "toile/cloth.hpp"\n'}
        self.accepts(tool, tree)
        self.refuses(tool, {**tree, "src/io/a.cpp": '\n#include "toile/cloth.hpp"\n'}, "src/io/a.cpp:2: 'io' may not include a public header")

    def test_a_module_that_is_kept_for_some_files(self):
        tool = "check_layers.py"
        tree = {"src/layers.txt": sound_tree["src/layers.txt"] + "only io mesh obj.cpp\n",
                "src/mesh/mesh.hpp": "int find_holes(int);\nclass HoleSearch {};\n"}
        self.accepts(tool, {**tree, "src/io/b.cpp": "int found = my_find_holes(1);  // not find_holes(1)\n"})
        self.refuses(tool, {**tree, "src/io/b.cpp": '\n#include "mesh/mesh.hpp"\n'}, "src/io/b.cpp:2: in 'io' only obj.cpp may include 'mesh'")
        self.refuses(tool, {**tree, "src/io/b.cpp": "int found = find_holes(1);\n"}, "src/io/b.cpp:1: 'find_holes' of 'mesh' is only for obj.cpp")
        self.refuses(tool, {**tree, "src/io/b.hpp": "HoleSearch search;\n"}, "'HoleSearch'")
        self.refuses(tool, {**tree, "src/layers.txt": tree["src/layers.txt"] + "only io mesh gone.cpp\n"}, "there is no src/io/gone.cpp")

    def test_elementary(self):
        tool = "check_elementary.py"
        self.refuses(tool, {"src/core/a.cpp": "\ndouble y = std::sin(x);\n"}, "src/core/a.cpp:2: 'std::sin' differs")
        self.refuses(tool, {"src/mesh/a.hpp": "double y = atan2f (x, z);\n"}, "'atan2f' differs")
        self.refuses(tool, {"src/mesh/a.cpp": "y = 2*::pow(x, 3);\n"}, "'::pow' differs")
        self.refuses(tool, {"src/mesh/a.cpp": "Eigen::AngleAxisd turn(1, axis);\n"}, "'AngleAxisd' differs")
        self.refuses(tool, {"src/mesh/a.cpp": "y = x.array().exp();\n"}, "'.exp' differs")
        self.accepts(tool, {"src/mesh/a.cpp": "y = ieee_sin(x) + std::sqrt(x) + arcsin(x);  // not std::sin(x)\n"})
        self.accepts(tool, {"src/mesh/a.cpp": 'name("sin(x)"); double exp = 1;\n', "src/preview/a.cpp": "std::sin(x);\n"})

    def test_links(self):
        tool = "check_docs.py"
        self.refuses(tool, {"docs/a.md": "\n[x](gone.md)\n"}, "docs/a.md:2: 'gone.md'")
        self.refuses(tool, {"docs/a.md": "[x](units.md#mass)\n"}, "'units.md#mass': there is no such heading")
        self.refuses(tool, {"docs/a.md": "as solver.md derives\n"}, "'solver.md': there is no such document")
        self.refuses(tool, {"docs/a.md": "`src/core/type.hpp`\n"}, "'src/core/type.hpp'")
        self.refuses(tool, {"docs/a.md": "`src/{io,solver}/*.cpp` `tests/*/gone_*.cpp`\n"}, "gone_")
        self.refuses(tool, {"docs/a.md": "`Mesh.IsTwo`\n"}, "'Mesh.IsTwo': there is no such test")
        self.refuses(tool, {"docs/a.md": "`gap_m = 0.002`\n"}, "'gap_m = 0.002': no source says so")
        program = {"examples/a.cpp": "int main() {\n  run();\n\n  return 0;\n}\n"}
        self.accepts(tool, {**program, "docs/a.md": "```cpp\nrun();\nreturn 0;\n```\n"})
        self.refuses(tool, {**program, "docs/a.md": "\n```cpp\nrun();\nreturn 1;\n```\n"}, "docs/a.md:2: this code is in no program")
        self.refuses(tool, {"src/core/a.cpp": "// docs/gone.md\n"}, "src/core/a.cpp:1")
        self.refuses(tool, {"src/core/a.cpp": "// docs/units.md#mass.\n"}, "docs/units.md#mass")
        self.accepts(tool, {"docs/a.md": "```\n[x](gone.md)\n```\n\n    [y](gone.md)\n\n<https://example.org/gone.md>\n"})

    def test_reason_codes(self):
        tool = "check_docs.py"
        source = {"src/core/a.hpp": '#pragma once\nnamespace reason {\nconstexpr std::string_view lost = "lost_cloth";\n}  // x\n'}
        page = "| `lost_cloth` | gone |\n\n| `other` | x |\n"
        self.refuses(tool, source, "src/core/a.hpp:3: 'lost_cloth'")
        self.refuses(tool, {**source, "docs/reason-codes.md": page}, "what to do")
        self.accepts(tool, {**source, "docs/reason-codes.md": page + "\n| `lost_cloth` | look for it |\n"})

    def test_commands(self):
        tool = "run_docs_commands.py"
        text = self.accepts(tool)
        self.assertIn("PATTERN is for the reader to fill in", text)
        self.assertIn("../elsewhere/body.obj is not in the repository", text)
        self.assertIn("demo   (takes minutes", text)
        self.refuses(tool, {}, "demo: expected exit 0, got 5", ["--long"])
        block = "```sh\n{}\n```\n"
        self.refuses(tool, {"docs/a.md": block.format("build/release/toile check bad.json")}, "expected exit 0, got 3")
        self.refuses(tool, {"docs/a.md": block.format("build/release/toile check shirt.json -v  # exit 3")}, "expected exit 3, got 0")
        self.refuses(tool, {"docs/a.md": block.format("make everything")}, "no such target")
        self.refuses(tool, {"README.md": "# Toile\n"}, "no command was run")
        self.accepts(tool, {"docs/a.md": "```\nbuild/release/toile check bad.json\n```\n"})


if __name__ == "__main__":
    unittest.main()
