"""Installs the package by pip in an empty environment, and uses it there.

Usage: wheel.py SOURCE_ROOT FOLDER       FOLDER is made anew; exit 77: no registry is within reach
"""
import pathlib
import shutil
import subprocess
import sys
import venv
import zipfile

use = """
import pickle, numpy, toile
sim = toile.Simulation(toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.05), "silk")
assert sim.advance(0.1).ok and sim.positions_m.shape[1] == 3
assert pickle.loads(pickle.dumps(sim)).state_hash == sim.state_hash
print(toile.__version__, sim.state_hash)
"""


def main():
    root, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    shutil.rmtree(folder, ignore_errors=True)
    venv.create(folder / "env", with_pip=True)
    python = folder / "env/bin/python"
    pip = [python, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    if subprocess.run([*pip, "install", "--retries", "1", "numpy", "nanobind", "scikit-build-core"]).returncode:
        print("skipped: pip cannot reach a registry")
        return 77
    subprocess.run([*pip, "wheel", "--no-deps", "--wheel-dir", folder, root], check=True)
    (wheel,) = folder.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    print(wheel.name, wheel.stat().st_size, "bytes:", *names, sep="\n  ")
    for needed in ("toile/__init__.py", "toile/py.typed", "toile/_toile.pyi"):
        assert needed in names, f"{needed} is not in the wheel"
    outside = [n for n in names if not n.startswith("toile/") and ".dist-info/" not in n]
    assert not outside, f"what is not the package is in the wheel: {outside}"
    subprocess.run([*pip, "install", wheel], check=True)
    subprocess.run([python, "-c", use], check=True, cwd=folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
