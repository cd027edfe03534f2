#!/usr/bin/env python3
"""Fails when a document or a comment points at something that is not there.

Usage: check_docs.py [SOURCE_ROOT]      prints every offence as file:line: ...; exit 1 if there is any.

Checked in documents (*.md in the root and in docs/):
  [text](path#anchor)        the file and the heading exist (addresses with a scheme are left alone)
  solver.md, docs/units.md   a document of that name exists
  `src/step/...`             the path exists; * and {a,b} must match something; <name> matches anything
  `Suite.Name`               a test of that name exists in tests/
  `name_m = 0.02`            a source in src/ gives that name that value
  ```cpp ... ```             a program of examples/ has these lines, blank ones left out
Checked in sources, scripts and build files:
  docs/...#anchor            the file and the heading exist
  reason codes               docs/reason-codes.md knows them
"""
import glob
import itertools
import pathlib
import re
import sys

source_folders = ["src", "apps", "include", "examples", "tests", "cmake", "tools", "bench", "scenes", "patterns", "python", "blender", ".ci"]
source_files = ["CMakeLists.txt", "Makefile", "CMakePresets.json"]
source_suffixes = {".hpp", ".cpp", ".txt", ".cmake", ".py", ".sh", ".json", ""}
code_path = re.compile(r"`((?:src|tests|tools|apps|cmake|patterns|scenes|bench|include|examples|docs)/[^\s`:]+)`")
test_name = re.compile(r"`([A-Z]\w+)\.([A-Z]\w+)`")
constant = re.compile(r"`([a-z]\w+) = (-?[\d.]+(?:e-?\d+)?)`")
link = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
docs_reference = re.compile(r"(?<![\w/.-])docs/[\w./-]*\w(?:#[\w-]+)?")
document_name = re.compile(r"(?<![\w./-])((?:[\w-]+/)*[\w-]+\.md(?![\w]))(#[\w-]+)?")


def without_code_blocks(text):
    """Lines of a document, those of fenced or indented blocks emptied."""
    lines, fence = [], None
    for line in text.splitlines():
        mark = re.match(r"\s*(```+|~~~+)", line)
        if mark and fence is None:
            fence = mark.group(1)
            lines.append("")
        elif fence is not None:
            if mark and mark.group(1).startswith(fence):
                fence = None
            lines.append("")
        else:
            lines.append("" if line.startswith("    ") else line)
    return lines


def anchors(path):
    """The anchors a reader can jump to: headings as GitHub spells them, and <a id="...">."""
    found = set()
    for line in without_code_blocks(path.read_text()):
        heading = re.match(r"#{1,6}\s+(.*)", line)
        if heading:
            words = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1)).strip().lower()
            found.add(re.sub(r"[^\w\- ]", "", words).replace(" ", "-"))
        found.update(re.findall(r'<a id="([^"]+)"', line))
    return found


def expand(pattern):
    """a{b,c} -> ab, ac"""
    parts = [part[1:-1].split(",") if part.startswith("{") else [part] for part in re.split(r"(\{[^}]*\})", pattern)]
    return ["".join(choice) for choice in itertools.product(*parts)]


class Checker:
    def __init__(self, root):
        self.root = root
        self.documents = sorted(root.glob("*.md")) + sorted((root / "docs").rglob("*.md"))
        self.sources = [root / name for name in source_files if (root / name).is_file()]
        for folder in source_folders:
            self.sources += sorted(p for p in (root / folder).rglob("*")
                                   if p.is_file() and p.suffix in source_suffixes and "__pycache__" not in p.parts)
        self.sources = [p for p in self.sources if p.name not in {pathlib.Path(__file__).name, "checkers_test.py"}]
        self.anchors = {path: anchors(path) for path in self.documents}
        self.tests = set()
        for path in sorted((root / "tests").rglob("*.cpp")):
            for suite, name in re.findall(r"TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)", path.read_text()):
                self.tests.add((suite, name))
        self.values = {}
        for path in sorted((root / "src").rglob("*.[ch]pp")):
            for name, value in re.findall(r"\b([a-z]\w+)\s*=\s*(-?[\d.]+(?:e-?\d+)?)\b", path.read_text()):
                self.values.setdefault(name, set()).add(float(value))
        self.offences = []

    def complain(self, path, number, words):
        self.offences.append(f"{path.relative_to(self.root)}:{number}: {words}")

    def check_target(self, path, number, base, target):
        """`target` is path#anchor, relative to `base`."""
        name, _, anchor = target.partition("#")
        file = (base / name).resolve() if name else path
        if not file.exists():
            self.complain(path, number, f"'{target}': there is no such file")
        elif anchor and file.suffix == ".md" and anchor not in self.anchors.get(file, anchors(file)):
            self.complain(path, number, f"'{target}': there is no such heading")

    def check_named_document(self, path, number, name, anchor):
        """A document mentioned in running text, by its name or by a path from anywhere sensible."""
        candidates = [base / name for base in (path.parent, self.root / "docs", self.root)]
        candidates += [d for d in self.documents if d.name == name]
        found = [c.resolve() for c in candidates if c.is_file()]
        if not found:
            self.complain(path, number, f"'{name}': there is no such document")
        elif anchor and not any(anchor[1:] in self.anchors.get(f, set()) for f in found):
            self.complain(path, number, f"'{name}{anchor}': there is no such heading")

    def check_excerpts(self, path):
        """Code in a document is part of a program that is built and run."""
        def lines_of(text):
            return "\n".join(line.strip() for line in text.splitlines() if line.strip())
        programs = [lines_of(p.read_text()) for p in sorted((self.root / "examples").glob("*.cpp"))]
        text = path.read_text()
        for block in re.finditer(r"^```cpp\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
            if not any(lines_of(block.group(1)) in program for program in programs):
                self.complain(path, text.count("\n", 0, block.start()) + 1, "this code is in no program of examples/")

    def check_document(self, path):
        self.check_excerpts(path)
        for number, line in enumerate(without_code_blocks(path.read_text()), 1):
            for target in link.findall(line):
                if not re.match(r"[a-z]+:", target):
                    self.check_target(path, number, path.parent, target)
            for pattern in code_path.findall(line):
                if "<" not in pattern and not any(glob.glob(str(self.root / p)) for p in expand(pattern.partition("#")[0])):
                    self.complain(path, number, f"'{pattern}': there is no such file")
            for suite, name in test_name.findall(line):
                if (suite, name) not in self.tests:
                    self.complain(path, number, f"'{suite}.{name}': there is no such test")
            for name, value in constant.findall(line):
                if float(value) not in self.values.get(name, set()):
                    self.complain(path, number, f"'{name} = {value}': no source says so")
            for name, anchor in document_name.findall(link.sub("", line)):
                self.check_named_document(path, number, name, anchor)

    def check_source(self, path):
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            return
        for number, line in enumerate(text.splitlines(), 1):
            for target in docs_reference.findall(line):
                self.check_target(path, number, self.root, target)
            if path.suffix in {".hpp", ".cpp"}:
                for name, anchor in document_name.findall(docs_reference.sub("", line)):
                    self.check_named_document(path, number, name, anchor)

    def check_reason_codes(self):
        """Every code in a `namespace reason` has a row in docs/reason-codes.md under what it means and under what to do."""
        page = self.root / "docs/reason-codes.md"
        rows = re.findall(r"^\| `(\w+)` \|", page.read_text(), re.MULTILINE) if page.is_file() else []
        for path in self.sources:
            if path.suffix not in {".hpp", ".cpp"} or self.root / "src" not in path.parents:
                continue
            text = path.read_text()
            for block in re.finditer(r"namespace reason \{(.*?)\n\}", text, re.DOTALL):
                for code in re.finditer(r'"(\w+)"', block.group(1)):
                    if rows.count(code.group(1)) < 2:
                        number = text.count("\n", 0, block.start(1) + code.start()) + 1
                        self.complain(path, number, f"'{code.group(1)}': docs/reason-codes.md must say what it means and what to do")

    def run(self):
        for path in self.documents:
            self.check_document(path)
        for path in self.sources:
            self.check_source(path)
        self.check_reason_codes()
        return self.offences


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent).resolve()
    checker = Checker(root)
    found = checker.run()
    print("\n".join(found) if found else
          f"docs: {len(checker.documents)} documents and {len(checker.sources)} sources point at things that exist")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
