"""The add-on, installed from its zip file, and what every test of it begins with."""
import os
import pathlib
import sys
import tempfile
import unittest

import bpy
import scenes

arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
archive, program, source = (pathlib.Path(a).resolve() for a in arguments[:3])
scratch = pathlib.Path(tempfile.mkdtemp(prefix="toile_blender_"))


def install():
    """By the way of this version of Blender; the name of the module."""
    if bpy.app.version >= (4, 2, 0):
        bpy.ops.extensions.package_install_files(filepath=str(archive), repo="user_default", enable_on_install=True)
        return "bl_ext.user_default.toile_blender"
    bpy.ops.preferences.addon_install(filepath=str(archive), overwrite=True)
    bpy.ops.preferences.addon_enable(module="toile_blender")
    return "toile_blender"


module = install()


def part(name):
    return sys.modules[f"{module}.{name}"]


def is_alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


class AddonTest(unittest.TestCase):
    def setUp(self):
        self.scene = scenes.empty_scene()
        bpy.ops.preferences.addon_enable(module=module)
        self.scene = bpy.context.scene
        bpy.context.preferences.addons[module].preferences.program = str(program)
        self.settings = self.scene.toile
        self.folder = scratch / self.id().rpartition(".")[2]
        self.settings.folder = str(self.folder)
        self.settings.quality, self.settings.threads = "draft", 1

    def dress(self):
        self.assertEqual(bpy.ops.toile.dress(), {"FINISHED"}, self.settings.details)

    def animate(self):
        self.assertEqual(bpy.ops.toile.animate(), {"FINISHED"}, self.settings.details)

    def refused(self, operator):
        """The text that the user gets."""
        with self.assertRaises(RuntimeError) as caught:
            operator()
        return str(caught.exception)

    def run_of(self, name, stage):
        return self.folder / name / stage
