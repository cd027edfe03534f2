#!/usr/bin/env python3
"""Fails when a module of src/ that can reach a position calls a function whose last bit is the C library's choice.

Usage: check_elementary.py [SOURCE_ROOT]      prints every offence as file:line: ...; exit 1 if there is any.

src/core/elementary.hpp has the replacements.  sqrt, fma, remainder, round and their like are exact by IEEE 754 and allowed.
"""
import pathlib
import re
import sys

free_modules = {"preview"}  # pictures are not part of a run's state

functions = ("sin cos tan asin acos atan atan2 sincos sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2 log10 log1p pow "
             "cbrt hypot erf erfc tgamma lgamma lerp").split()
call = re.compile(r"(?<![\w.>])(?:std::|::)?(" + "|".join(functions) + r")[fl]?\s*\(")
# Parts of Eigen and methods of its arrays that call them.
eigen = re.compile(r"\b(AngleAxisd?|Rotation2Dd?|eulerAngles|canonicalEulerAngles|angularDistance|computeDirect|"
                   r"stableNorm|hypotNorm)\b|\.(sin|cos|tan|asin|acos|atan|exp|log|log10|log1p|pow|sinh|cosh|tanh|slerp)\(")


def offences(root):
    for path in sorted((root / "src").glob("*/*.[ch]pp")):
        if path.parent.name in free_modules:
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            code = re.sub(r'"(?:[^"\\]|\\.)*"', '""', line).split("//")[0]
            found = call.search(code) or eigen.search(code)
            if found:
                yield (f"{path.relative_to(root)}:{number}: '{found.group(0).rstrip('(').strip()}' differs from C library to C library: "
                       "use core/elementary.hpp")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
    found = list(offences(root))
    print("\n".join(found) if found else "elementary: no function of the C library that may differ")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
