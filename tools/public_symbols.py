#!/usr/bin/env python3
"""What a library of Toile shows of namespace toile, without toile::internal: one demangled name a line, sorted.

Usage: public_symbols.py LIBRARY                  prints them
       public_symbols.py --check LIST LIBRARY     prints where they differ from the list; exit 1 if they do
       public_symbols.py --write LIST LIBRARY     writes the list (`make symbols`)

Shown is what is not hidden (TOILE_EXPORT), in a static library (.a) and in a shared one (.so), which may export nothing but this.
Weak symbols are left out: they come with headers, and which of them are there depends on what a compiler inlines.  So are the tables of classes,
which are weak for one compiler and not for another.
"""
import argparse
import pathlib
import re
import subprocess
import sys

public = re.compile(r"toile::(?!internal::)")
table = re.compile(r"(?:vtable|typeinfo|typeinfo name) for (toile::(?!internal::))")


def defined_symbols(library):
    """[(binding, demangled name)] of what is defined and not hidden."""
    shared = ".so" in pathlib.Path(library).name
    command = ["readelf", "--wide", "--dyn-syms" if shared else "--syms", library]
    lines = subprocess.run(command, check=True, capture_output=True, text=True, errors="replace").stdout.splitlines()
    # Num: Value Size Type Bind Vis Ndx Name
    rows = [row for row in map(str.split, lines) if len(row) >= 8 and row[0].endswith(":") and row[0][:-1].isdigit()]
    visible = [row for row in rows if row[4] != "LOCAL" and row[5] == "DEFAULT" and row[6] not in {"UND", "ABS"}]
    mangled = "\n".join(row[7].partition("@")[0] for row in visible) + "\n"
    names = subprocess.run(["c++filt"], input=mangled, check=True, capture_output=True, text=True).stdout.splitlines()
    return [(row[4], name) for row, name in zip(visible, names)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", type=pathlib.Path, metavar="LIST")
    parser.add_argument("--write", type=pathlib.Path, metavar="LIST")
    parser.add_argument("library")
    options = parser.parse_args()
    symbols = defined_symbols(options.library)
    shown = sorted({name for binding, name in symbols if binding == "GLOBAL" and public.match(name)})
    if ".so" in pathlib.Path(options.library).name:
        strangers = sorted({name for _, name in symbols if not public.match(name) and not table.match(name)})
        if strangers:
            print("\n".join(f"{options.library} exports what is not public: {name}" for name in strangers[:20]))
            return 1
    if not shown:
        print(f"{options.library} shows nothing of namespace toile")
        return 1
    if options.write:
        options.write.write_text("\n".join(shown) + "\n")
    elif options.check:
        listed = options.check.read_text().splitlines()
        if listed == shown:
            print(f"symbols: {len(shown)}, as listed")
            return 0
        print("\n".join([f"shown and not listed: {name}" for name in shown if name not in listed] +
                        [f"listed and not shown: {name}" for name in listed if name not in shown] or
                        ["the list is not sorted"]))
        print(f"`make symbols` writes {options.check} anew; what has gone from it breaks programs of others")
        return 1
    else:
        print("\n".join(shown))
    return 0


if __name__ == "__main__":
    sys.exit(main())
