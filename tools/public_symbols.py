#!/usr/bin/env python3
"""What a library of Toile shows of namespace toile, without toile::internal: one demangled name a line, sorted.

Usage: public_symbols.py LIBRARY                  prints them
       public_symbols.py --check LIST LIBRARY     prints where they differ from the list; exit 1 if they do
       public_symbols.py --write LIST LIBRARY     writes the list (`make symbols`)

A static library (.a) shows all that other files can be linked with, a shared one (.so) all that it exports, and that may be nothing but this.
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
    """[(type, demangled name)] of what other files can see."""
    shared = ".so" in pathlib.Path(library).name
    command = ["nm", "--extern-only", "--defined-only", "--demangle", "--format=posix", *(["--dynamic"] if shared else []), library]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    # NAME TYPE VALUE [SIZE]; names have spaces.
    found = (re.fullmatch(r"(.+) ([A-Za-z]) [0-9a-f]*(?: [0-9a-f]*)?", line.strip()) for line in lines)
    return [(match.group(2), match.group(1)) for match in found if match]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", type=pathlib.Path, metavar="LIST")
    parser.add_argument("--write", type=pathlib.Path, metavar="LIST")
    parser.add_argument("library")
    options = parser.parse_args()
    symbols = defined_symbols(options.library)
    shown = sorted({name for kind, name in symbols if kind not in "VvWwu" and public.match(name)})
    if ".so" in pathlib.Path(options.library).name:
        strangers = sorted({name for kind, name in symbols if kind != "A" and not public.match(name) and not table.match(name)})
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
