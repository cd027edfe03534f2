#!/usr/bin/env python3
"""Makes the add-on's zip file and tests it in each Blender there is, without a window and, where there is Xvfb, in one.

Usage: run.py --program TOILE --source SOURCE_ROOT [--blender PROGRAM_OR_PYTHON]... [TEST...]

--blender: a program `blender`, or a Python that has the module bpy; without it those of the environment variable TOILE_BLENDER (separated by colons), else
`blender` in PATH.  Exit 77: there is none, nothing was tested.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent


def command_of(blender, script, words):
    if "python" in pathlib.Path(blender).name:
        return [blender, script, *words]
    return [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", script, "--", *words]


def run(blender, script, words, environment):
    print(f"{blender}: {script}", flush=True)
    return abs(subprocess.run(command_of(blender, str(here / script), words), env=environment, check=False).returncode)


def in_a_window(blender, words, environment):
    """On a display of its own.  The module bpy has no windows."""
    if "python" in pathlib.Path(blender).name:
        return 0
    if shutil.which("Xvfb") is None:
        print("skipped: in_window.py: there is no Xvfb (Debian: xvfb)")
        return 0
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24"], pass_fds=[write], stderr=subprocess.DEVNULL)
    try:
        display = os.read(read, 16).decode().strip()
        print(f"{blender}: in_window.py on display {display}", flush=True)
        command = [blender, "--factory-startup", "--window-geometry", "0", "0", "640", "480", "--python", str(here / "in_window.py"), "--", *words]
        return abs(subprocess.run(command, env={**environment, "DISPLAY": f":{display}", "LIBGL_ALWAYS_SOFTWARE": "1"}, check=False).returncode)
    finally:
        server.terminate()
        server.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--blender", action="append")
    parser.add_argument("tests", nargs="*")
    options = parser.parse_args()
    blenders = options.blender or [word for word in os.environ.get("TOILE_BLENDER", "").split(":") if word] or [shutil.which("blender")]
    if blenders == [None]:
        print("skipped: there is no Blender: `make test-blender` installs Debian's, or name one in TOILE_BLENDER")
        return 77
    worst = 0
    with tempfile.TemporaryDirectory(prefix="toile_addon_") as folder:
        archive = pathlib.Path(folder) / "toile_blender.zip"
        subprocess.run([sys.executable, options.source / "blender/package.py", archive, "--program", options.program], check=True)
        for number, blender in enumerate(blenders):
            # Its own settings folder: the user's add-ons stay as they are.  A plain PATH: Debian's Blender takes the modules of the first python3 there.
            user = pathlib.Path(folder) / f"user{number}"
            user.mkdir()
            environment = {**os.environ, "BLENDER_USER_RESOURCES": str(user), "PATH": os.defpath}
            words = [str(archive), str(options.program), str(options.source)]
            worst = max(worst, run(blender, "in_blender.py", [*words, *options.tests], environment))
            if not options.tests:
                worst = max(worst, *(run(blender, script, words, environment) for script in ("exports.py", "poses.py")), in_a_window(blender, words, environment))
    return 1 if worst else 0


if __name__ == "__main__":
    sys.exit(main())
