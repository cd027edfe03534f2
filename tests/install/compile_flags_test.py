#!/usr/bin/env python3
"""Every source of ours is compiled by the rules that make results the same bits everywhere.

Usage: compile_flags_test.py COMPILE_COMMANDS
"""
import json
import pathlib
import shlex
import sys

root = pathlib.Path(__file__).resolve().parent.parent.parent

rules = ["-ffp-contract=off", "-fno-fast-math", "-fvisibility=hidden"]


def breaks_of(entry):
    words = shlex.split(entry["command"])
    missing = [rule for rule in rules if rule not in words]
    for rule in missing:
        yield f"{rule} is missing"
    of_clang = any("clang" in word for word in words[:2])  # behind ccache, or not
    if of_clang and not missing and words[::-1].index("-ffp-contract=off") > words[::-1].index("-fno-fast-math"):
        yield "-fno-fast-math stands behind -ffp-contract=off"
    if not missing:
        behind = words[words.index("-fno-fast-math"):]
        for word in ("-ffast-math", "-Ofast", "-ffp-contract=fast", "-ffp-contract=on", "-funsafe-math-optimizations"):
            if word in behind:
                yield f"{word} stands behind -fno-fast-math"


def offences(path):
    # Sources of others that we compile, nanobind's, lie elsewhere or in an environment of Python's.
    entries = [entry for entry in json.loads(pathlib.Path(path).read_text())
               if root in pathlib.Path(entry["file"]).parents and "site-packages" not in entry["file"]]
    if not entries:
        yield "no source is compiled at all"
    for entry in entries:
        for words in breaks_of(entry):
            yield f"{entry['file']}: {words}"


if __name__ == "__main__":
    found = list(offences(sys.argv[1]))
    print("\n".join(found[:20]) if found else "every source is compiled by the rules of cmake/toile_options.cmake")
    sys.exit(1 if found else 0)
