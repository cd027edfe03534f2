#!/usr/bin/env python3
"""Fails when a module of src/ includes one that is not below it in src/layers.txt.

Usage: check_layers.py [SOURCE_ROOT]      prints every offence as file:line: ...; exit 1 if there is any.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
layer = {}
for number, line in enumerate(l for l in (root / "src/layers.txt").read_text().splitlines() if l and not l.startswith("#")):
    for module in line.split():
        layer[module] = number

offences = []
for path in sorted((root / "src").glob("*/*.[ch]pp")):
    module = path.parent.name
    if module not in layer:
        offences.append(f"{path.relative_to(root)}: module '{module}' is not in src/layers.txt")
        continue
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = re.match(r'\s*#\s*include\s+"([a-z_0-9]+)/', line)
        if not found or found.group(1) == module:
            continue
        other = found.group(1)
        if other not in layer:
            offences.append(f"{path.relative_to(root)}:{number}: includes unknown module '{other}'")
        elif layer[other] >= layer[module]:
            offences.append(f"{path.relative_to(root)}:{number}: '{module}' may not include '{other}'")
print("\n".join(offences) if offences else f"{len(layer)} modules in order")
sys.exit(1 if offences else 0)
