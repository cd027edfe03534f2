#!/usr/bin/env python3
"""Fails when a module of src/ includes one that is not below it in src/layers.txt, or one that it is not linked with, or when a file uses one
that a line `only` keeps for others.  The public headers, include/toile, belong to the highest module alone.

Usage: check_layers.py [SOURCE_ROOT]      prints every offence as file:line: ...; exit 1 if there is any.
"""
import pathlib
import re
import sys


def read_layers(text):
    """{module: number of its line}"""
    lines = [line.split("#")[0].split() for line in text.splitlines()]
    return {module: number for number, line in enumerate(lines) if line[:1] != ["only"] for module in line}


def read_kept(text):
    """[(module, other, files of the module that may use the other)]"""
    lines = [line.split("#")[0].split() for line in text.splitlines()]
    return [(line[1], line[2], set(line[3:])) for line in lines if line[:1] == ["only"]]


def finders_of(folder):
    """What finds crossings in a module: functions find_... and classes ...Search of its headers."""
    names = set()
    for header in folder.glob("*.hpp"):
        names.update(re.findall(r"\b(find_\w+)\(|^class (\w+Search)\b", header.read_text(), re.MULTILINE))
    return {name for pair in names for name in pair if name}


def kept_offences(root, kept):
    for module, other, files in kept:
        names = finders_of(root / "src" / other)
        used = re.compile(r"\b(" + "|".join(sorted(names)) + r")\b") if names else None
        for name in sorted(files):
            if not (root / "src" / module / name).exists():
                yield f"src/layers.txt: there is no src/{module}/{name}"
        for path in sorted((root / "src" / module).glob("*.[ch]pp")):
            if path.name in files:
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                place = f"{path.relative_to(root)}:{number}"
                if re.match(rf'\s*#\s*include\s+"{other}/', line):
                    yield f"{place}: in '{module}' only {', '.join(sorted(files))} may include '{other}'"
                elif used and (found := used.search(line.split("//")[0])):
                    yield f"{place}: '{found.group(1)}' of '{other}' is only for {', '.join(sorted(files))}"


def read_links(cmake):
    """{module: every module that it is linked with}, from the calls toile_module(name DEPENDS ...)"""
    depends = {}
    for call in re.findall(r"toile_module\(([^)]*)\)", cmake):
        words = call.split()
        names = words[words.index("DEPENDS") + 1:] if "DEPENDS" in words else []
        depends[words[0]] = names[:names.index("LIBRARIES")] if "LIBRARIES" in names else names
    reached = {}
    for module, direct in depends.items():
        reached[module], pending = set(), list(direct)
        while pending:
            other = pending.pop()
            if other not in reached[module]:
                reached[module].add(other)
                pending += depends.get(other, [])
    return reached


def public_offence(module, layer, place):
    top = max(layer, key=layer.get)
    return f"{place}: '{module}' may not include a public header: they are above all modules but '{top}'" if module != top else None


def offences(root):
    layer = read_layers((root / "src/layers.txt").read_text())
    links = read_links((root / "src/CMakeLists.txt").read_text())
    for path in sorted((root / "src").glob("*/*.[ch]pp")):
        module, place = path.parent.name, path.relative_to(root)
        if module not in layer:
            yield f"{place}: module '{module}' is not in src/layers.txt"
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            found = re.match(r'\s*#\s*include\s+"([a-z_0-9]+)/', line)
            if not found or found.group(1) == module:
                continue
            other = found.group(1)
            if other == "toile":
                if offence := public_offence(module, layer, f"{place}:{number}"):
                    yield offence
            elif other not in layer:
                yield f"{place}:{number}: includes unknown module '{other}'"
            elif layer[other] >= layer[module]:
                yield f"{place}:{number}: '{module}' may not include '{other}'"
            elif other not in links.get(module, set()):
                yield f"{place}:{number}: '{module}' includes '{other}' but src/CMakeLists.txt does not link it"
    yield from kept_offences(root, read_kept((root / "src/layers.txt").read_text()))
    for module in sorted(layer.keys() - links.keys()):
        yield f"src/layers.txt: module '{module}' is not in src/CMakeLists.txt"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
    found = list(offences(root))
    print("\n".join(found) if found else "layers: all modules in order")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
