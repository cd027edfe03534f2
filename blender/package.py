#!/usr/bin/env python3
"""Makes the add-on's zip file, for Blender 3.4 to 4.1 (bl_info) and for 4.2 and newer (blender_manifest.toml).

Usage: package.py OUT.zip [--program build/release/toile]

--program: is carried along, in bin/; the file is then for the system that it was built on.
"""
import argparse
import os
import pathlib
import platform
import re
import sys
import zipfile

root = pathlib.Path(__file__).resolve().parent
package = root / "toile_blender"
same_date = (2020, 1, 1, 0, 0, 0)  # the same sources give the same bytes


def version_of_toile():
    text = (root.parent / "CMakeLists.txt").read_text()
    return re.search(r"project\(toile VERSION ([0-9.]+)", text).group(1)


def check_versions():
    version = version_of_toile()
    in_info = "(" + ", ".join(version.split(".")) + ")"
    for name, expected in (("__init__.py", f'"version": {in_info}'), ("blender_manifest.toml", f'\nversion = "{version}"\n')):
        if expected not in (package / name).read_text():
            sys.exit(f"package.py: {package / name}: expected {expected.strip()}, the version in CMakeLists.txt")


def system():
    """As the manifest names it."""
    machine = {"x86_64": "x64", "AMD64": "x64", "aarch64": "arm64"}.get(platform.machine(), platform.machine())
    return {"Linux": "linux", "Darwin": "macos", "Windows": "windows"}[platform.system()] + "-" + machine


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path)
    options = parser.parse_args()
    check_versions()
    files = {path.relative_to(root).as_posix(): path.read_bytes() for path in sorted(package.rglob("*")) if path.suffix in {".py", ".toml"}}
    files["toile_blender/LICENSE"] = (root.parent / "LICENSE").read_bytes()
    if options.program:
        manifest = "toile_blender/blender_manifest.toml"
        files[manifest] = files[manifest].replace(b"\n[permissions]", f'platforms = ["{system()}"]\n\n[permissions]'.encode(), 1)
        files["toile_blender/bin/" + options.program.name] = options.program.read_bytes()
    options.out.parent.mkdir(parents=True, exist_ok=True)
    partial = options.out.with_name(options.out.name + ".partial")
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, same_date)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if "/bin/" in name else 0o644) << 16
            archive.writestr(entry, data)
    os.replace(partial, options.out)
    print(f"{options.out}: {len(files)} files, {options.out.stat().st_size} bytes")


if __name__ == "__main__":
    main()
