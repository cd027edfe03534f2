"""The add-on in a real Blender, installed from its zip file.

Usage: blender -b --factory-startup --python-exit-code 1 --python in_blender.py -- ZIP PROGRAM SOURCE_ROOT [TEST...]
       python in_blender.py ZIP PROGRAM SOURCE_ROOT [TEST...]      with the module bpy
"""
import os
import pathlib
import shutil
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.dont_write_bytecode = True

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from addon import arguments, scratch  # noqa: E402
from cloth_tests import Cloth  # noqa: E402
from process_tests import Process  # noqa: E402


def main():
    print(f"Blender {bpy.app.version_string}, Python {sys.version.split()[0]}, NumPy {np.__version__}")
    names = arguments[3:]
    suite = unittest.TestSuite()
    for case in (Cloth, Process):
        suite.addTests(case(name) for name in unittest.defaultTestLoader.getTestCaseNames(case) if not names or name in names)
    if suite.countTestCases() < max(len(names), 1):
        print(f"expected names of tests, got {names}")
        return 1
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    shutil.rmtree(scratch, ignore_errors=True)
    return 0 if result.wasSuccessful() else 1


# Blender itself goes on after a script that ends well.
code = main()
sys.stdout.flush()
sys.stderr.flush()
os._exit(code)
