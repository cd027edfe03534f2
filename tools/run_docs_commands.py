#!/usr/bin/env python3
"""Runs the commands that the documents show, so that no reader is the first to try them.

Usage: run_docs_commands.py [--root SOURCE_ROOT] [--program-dir DIR] [--long] [--list]

Read are fenced blocks that open with ```sh in README.md and docs/**.md:
  build/release/toile ...   is run, each distinct line once, in document order.  The working directory is a temporary one in
                            which every entry of the source root appears as a link, so out/ is the only thing written
  make TARGET ...           TARGET must be in the Makefile (make itself is not run: this runs inside `make test`)
  everything else           is left alone

A block that opens with ```sh long is run only with --long: it takes minutes.
A comment behind a command that says "exit 3" is the exit code expected; otherwise it is 0.
Not run, and said so: commands with a word in CAPITALS for the reader to fill in, and commands that read a file
that the repository does not have.

--program-dir: where the program is (default: build/release).     --list: show what would be run.
"""
import argparse
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

program = "build/release/toile"
timeout_s = 900
file_suffixes = (".json", ".obj", ".pc2", ".png", ".mp4", ".glb", ".usd")


class Command:
    def __init__(self, place, line, long):
        self.place, self.long = place, long
        code, _, comment = line.partition(" #")
        self.line = code.strip()
        expected = re.search(r"\bexit (\d+)", comment)
        self.expected = int(expected.group(1)) if expected else 0
        self.words = shlex.split(self.line)
        while self.words and re.match(r"[A-Z_]+=", self.words[0]):
            self.words.pop(0)
        if "|" in self.words:                       # the reader's own tools may not be here
            self.words = self.words[:self.words.index("|")]

    def makes(self):
        return bool(self.words) and self.words[0] == "make"

    def runs(self):
        return bool(self.words) and self.words[0] == program


def commands_of(path, root):
    opened, long, pending = False, False, ""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.lstrip().startswith("```"):
            info = line.strip()[3:].split()
            opened = not opened and info[:1] == ["sh"]
            long = "long" in info
            pending = ""
            continue
        if not opened:
            continue
        pending += line.strip()
        if pending.endswith("\\"):
            pending = pending[:-1]
            continue
        if pending and not pending.startswith("#"):
            yield Command(f"{path.relative_to(root)}:{number}", pending.removeprefix("$ "), long)
        pending = ""


def reason_to_skip(command, work):
    """Why the command cannot be run here; empty when it can."""
    made_here = set()
    for previous, word in zip(command.words, command.words[1:]):
        if previous in {"--out", "--svg", "--repair"}:
            made_here.add(word)
            continue
        if word.startswith("-"):
            continue
        if re.fullmatch(r"[A-Z][A-Z_.]*", word):
            return f"{word} is for the reader to fill in"
        looks_like_a_file = "/" in word or word.endswith(file_suffixes)
        if looks_like_a_file and word not in made_here and not (work / word).exists():
            made = word.startswith("out/")
            return f"{word} " + ("is made by a command that was not run" if made else "is not in the repository")
    return ""


def targets_of(makefile):
    return set(re.findall(r"^([A-Za-z][\w-]*)\s*:(?!=)", makefile.read_text(), re.MULTILINE))


def check_make(command, targets):
    wanted = [w for w in command.words[1:] if not w.startswith("-") and "=" not in w]
    return [f"{command.place}: make {target}: the Makefile has no such target" for target in wanted if target not in targets]


def run(command, work):
    start = time.monotonic()
    try:
        result = subprocess.run(command.words, cwd=work, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, errors="replace", timeout=timeout_s, check=False)
    except subprocess.TimeoutExpired:
        return f"{command.place}: {command.line}: not done after {timeout_s} s; mark its block ```sh long"
    print(f"ran      {command.line}   ({time.monotonic() - start:.1f} s, exit {result.returncode})", flush=True)
    if result.returncode == command.expected:
        return ""
    tail = "\n    ".join(result.stdout.strip().splitlines()[-12:])
    return f"{command.place}: {command.line}: expected exit {command.expected}, got {result.returncode}\n    {tail}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--program-dir", type=pathlib.Path)
    parser.add_argument("--long", action="store_true", help="run the blocks marked long, too")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    root = options.root.resolve()
    program_dir = (options.program_dir or root / "build/release").resolve()
    targets = targets_of(root / "Makefile")

    offences, seen, ran = [], set(), 0
    with tempfile.TemporaryDirectory(prefix="toile_docs_") as folder:
        work = pathlib.Path(folder)
        for entry in root.iterdir():
            if entry.name not in {"build", "out", ".git"}:
                os.symlink(entry, work / entry.name)
        (work / "build").mkdir()
        os.symlink(program_dir, work / "build/release")
        for document in sorted(root.glob("*.md")) + sorted((root / "docs").rglob("*.md")):
            for command in commands_of(document, root):
                if command.makes():
                    offences += check_make(command, targets)
                once = (tuple(command.words), command.expected)
                if not command.runs() or once in seen:
                    continue
                seen.add(once)
                skip = "takes minutes: run with --long" if command.long and not options.long else reason_to_skip(command, work)
                if skip:
                    print(f"skipped  {command.line}   ({skip})", flush=True)
                elif options.list:
                    print(f"would run {command.line}")
                    ran += 1
                else:
                    ran += 1
                    offences += filter(None, [run(command, work)])
    if ran == 0:
        offences.append("no command was run: is this the source root?")
    print("\n".join(offences) if offences else f"docs: {ran} commands do what the documents say")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
