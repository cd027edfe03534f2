"""The program beside Blender: found, begun, stopped, gone on with; what the user is told."""
import pathlib
import subprocess
import sys
import time

import bpy
import scenes
from addon import AddonTest, archive, is_alive, module, part, program, scratch

# Another Blender that quits while the program works.
QUITS = """
import sys, time
sys.path.insert(0, {tests!r})
sys.dont_write_bytecode = True
import bpy, scenes
scenes.empty_scene()
bpy.ops.preferences.addon_enable(module={module!r})
bpy.context.preferences.addons[{module!r}].preferences.program = {program!r}
settings = bpy.context.scene.toile
settings.garment, settings.folder = scenes.cloth_sheet(cells=60), {folder!r}
job = sys.modules[{module!r} + ".operators"].begin(sys.modules[{module!r} + ".steps"].dress)
while job.tick() and job.pid is None:
    time.sleep(0.01)
print("pid", job.pid, flush=True)
"""


class Process(AddonTest):
    def test_pressing_again_runs_nothing_again(self):
        body, _ = scenes.body_with_armature()
        self.settings.garment, self.settings.body = scenes.cloth_sheet(), body
        self.dress()
        report = self.run_of("Cloth", "dress") / "run/report.json"
        first = report.stat().st_mtime_ns
        self.dress()
        self.assertEqual(report.stat().st_mtime_ns, first)
        self.settings.fabric = "denim"
        self.dress()
        self.assertNotEqual(report.stat().st_mtime_ns, first)

    def test_stop_leaves_nothing_running(self):
        body, _ = scenes.body_with_armature()
        self.scene.frame_end = 4000
        cloth = scenes.cloth_sheet()
        self.settings.garment, self.settings.body = cloth, body
        operators, steps = part("operators"), part("steps")
        job = operators.begin(steps.animate)
        with self.assertRaises(RuntimeError):  # one at a time
            bpy.ops.toile.dress()
        while job.tick() and job.pid is None:
            time.sleep(0.01)
        pid = job.pid
        self.assertTrue(is_alive(pid))
        bpy.ops.toile.stop()
        job.finish()
        self.assertEqual(job.error, "")
        self.assertFalse(is_alive(pid))
        self.assertFalse(bpy.ops.toile.stop.poll())
        self.assertTrue(self.settings.status.startswith("Stopped"))
        self.scene.frame_end = 5000
        self.dress()  # goes on from there
        job = operators.begin(steps.animate)
        while job.tick() and not job.progress.words.startswith("writing frame"):
            pass
        bpy.ops.toile.stop()  # while Blender itself writes
        self.assertTrue(job.done)
        leftovers = [p.name for p in self.folder.rglob("*.partial")]
        self.assertEqual(leftovers, [])
        self.assertEqual(self.scene.frame_current, self.scene.frame_start)

    def test_a_saved_file_finds_its_cache_again(self):
        self.folder.mkdir(parents=True)
        body, _ = scenes.body_with_armature()
        self.settings.garment, self.settings.body, self.settings.folder = scenes.cloth_sheet(), body, "//toile"
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "a.blend"))
        self.dress()
        self.assertTrue(bpy.data.objects["Cloth"].modifiers["Toile"].filepath.startswith("//toile"))
        bpy.ops.wm.save_mainfile()
        moved = self.folder.with_name("moved")
        self.folder.rename(moved)  # to another place, with what belongs to it
        bpy.ops.wm.open_mainfile(filepath=str(moved / "a.blend"))
        cloth, run = bpy.data.objects["Cloth"], moved / "toile/Cloth/dress/run"
        self.assertEqual(bpy.context.scene.toile.status, "Verdict: pass")
        samples = len(scenes.samples(run / "cloth.pc2"))
        self.assertLess(scenes.farthest(cloth, run / "cloth.pc2", bpy.context.scene.frame_start - samples + 1), 1e-6)

    def test_a_garment_that_is_edited_meanwhile_is_told(self):
        body, _ = scenes.body_with_armature()
        cloth = scenes.cloth_sheet(cells=4)
        self.settings.garment, self.settings.body = cloth, body
        job = part("operators").begin(part("steps").dress)
        while job.tick() and job.pid is None:
            pass
        cloth.data.vertices.add(1)
        job.finish()
        self.assertIn("had 25 vertices when it was written and has 26 now", job.error)

    def test_opening_another_file_and_switching_off_end_the_program(self):
        body, _ = scenes.body_with_armature()
        for end in ("unregister", "file"):
            settings = bpy.context.scene.toile
            cloth = bpy.data.objects.get("Cloth") or scenes.cloth_sheet()
            settings.garment, settings.body, settings.folder = cloth, body, str(self.folder / end)
            operators, steps = part("operators"), part("steps")
            job = operators.begin(steps.dress)
            while job.tick() and job.pid is None:
                time.sleep(0.01)
            pid = job.pid
            self.assertTrue(is_alive(pid))
            if end == "unregister":
                bpy.ops.preferences.addon_disable(module=module)
                self.assertFalse(hasattr(bpy.types.Scene, "toile"))
                self.assertFalse(is_alive(pid))
                bpy.ops.preferences.addon_enable(module=module)
                bpy.context.preferences.addons[module].preferences.program = str(program)
            else:
                bpy.ops.wm.read_homefile(use_empty=True)
                self.assertFalse(is_alive(pid))

    def test_quitting_ends_the_program(self):
        script = scratch / "quits.py"
        script.write_text(QUITS.format(tests=str(pathlib.Path(__file__).parent), module=module, program=str(program), folder=str(self.folder)))
        blender = [bpy.app.binary_path, "-b", "--factory-startup", "--python", script] if bpy.app.binary_path else [sys.executable, script]
        done = subprocess.run(blender, capture_output=True, text=True, check=False)
        line = [text for text in done.stdout.splitlines() if text.startswith("pid ")]
        self.assertEqual(len(line), 1, done.stdout + done.stderr)
        self.assertFalse(is_alive(int(line[0].split()[1])))

    def test_errors_reach_the_user(self):
        self.assertIn("choose the object", self.refused(bpy.ops.toile.dress))
        cloth = scenes.cloth_sheet()
        open_body = scenes.link("Open", scenes.half_ball())
        self.settings.garment, self.settings.body = cloth, open_body
        text = self.refused(bpy.ops.toile.dress)
        self.assertIn("body.obj", text)  # the program's own words
        self.assertEqual(self.settings.details, text.removeprefix("Error: ").strip())
        open_body.hide_viewport = True
        self.assertIn("'Open' is hidden", self.refused(bpy.ops.toile.dress))
        self.settings.body = cloth
        self.assertIn("same object", self.refused(bpy.ops.toile.dress))
        self.settings.body = None
        cloth.modifiers.new("Mirror", "MIRROR")
        self.assertIn("'Mirror' of 'Cloth' cannot stay", self.refused(bpy.ops.toile.dress))
        self.settings.source, self.settings.pattern = "PATTERN", str(self.folder / "none.json")
        self.assertIn("none.json", self.refused(bpy.ops.toile.dress))
        bpy.context.preferences.addons[module].preferences.program = str(self.folder / "nowhere")
        self.settings.source = "MESH"
        cloth.modifiers.remove(cloth.modifiers["Mirror"])
        self.assertIn("nowhere", self.refused(bpy.ops.toile.dress))

    def test_the_package_is_what_extensions_must_be(self):
        """By Blender's own check, since there is one."""
        if bpy.app.version < (4, 2, 0):
            self.skipTest("add-ons before 4.2 have no manifest")
        check = pathlib.Path(sys.modules["bl_pkg"].__file__).parent / "cli/blender_ext.py"
        python = sys.executable
        done = subprocess.run([python, check, "validate", archive], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_register_round_trip(self):
        for _ in range(2):
            bpy.ops.preferences.addon_disable(module=module)
            self.assertFalse(hasattr(bpy.types.Scene, "toile"))
            self.assertFalse(hasattr(bpy.types, "TOILE_PT_main"))
            bpy.ops.preferences.addon_enable(module=module)
            self.assertTrue(hasattr(bpy.types.Scene, "toile") and hasattr(bpy.types, "TOILE_PT_main"))

    def test_the_carried_program_is_found(self):
        bpy.context.preferences.addons[module].preferences.program = ""
        found = part("engine.find_program").find("", search_path="")
        self.assertEqual(found.parent.name, "bin")
        self.assertRegex(part("engine.find_program").version(found), r"^[0-9.]+$")
