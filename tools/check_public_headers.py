#!/usr/bin/env python3
"""Fails when a header of include/toile cannot be used alone, or shows more than the standard library and other public headers.

Usage: check_public_headers.py SOURCE_ROOT COMPILER      prints every offence; exit 1 if there is any.

  at most ten headers                                    somebody reads them all
  #include <vector>, "toile/cloth.hpp"                   and nothing else: no library of others, no part of src/
  compiles alone, without a warning                      with no include path but include/
"""
import pathlib
import re
import subprocess
import sys

most_headers = 10
allowed = re.compile(r'\s*#\s*include\s+(?:<[a-z_0-9]+>|"toile/[a-z_0-9]+\.hpp"|<toile/[a-z_0-9]+\.hpp>)\s*(?://.*)?$')


def offences(root, compiler):
    headers = sorted((root / "include").rglob("*.*"))
    if not headers:
        yield "include/toile: no header is there"
    if len(headers) > most_headers:
        yield f"include/toile: {len(headers)} headers, at most {most_headers}"
    for header in headers:
        place = header.relative_to(root)
        if header.parent != root / "include/toile" or header.suffix != ".hpp":
            yield f"{place}: public headers are include/toile/*.hpp"
        for number, line in enumerate(header.read_text().splitlines(), 1):
            if re.match(r"\s*#\s*include", line) and not allowed.match(line):
                yield f"{place}:{number}: {line.strip()}: only the standard library and public headers may be included"
        # Twice: a header without a guard would be seen.
        text = f'#include "toile/{header.name}"\n' * 2
        command = [compiler, "-x", "c++", "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", str(root / "include"), "-"]
        done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            yield f"{place}: does not compile alone:\n{done.stderr.strip()}"


def main():
    found = list(offences(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]))
    print("\n".join(found) if found else "public headers: each stands alone")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
