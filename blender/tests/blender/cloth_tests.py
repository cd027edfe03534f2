"""What goes out of Blender, and what comes back."""
import json
import subprocess

import bpy
import numpy as np
import scenes
from addon import AddonTest, program, source


class Cloth(AddonTest):
    def test_garment_and_armature_body_out_cache_back(self):
        body, _ = scenes.body_with_armature()
        cloth = scenes.cloth_sheet()
        self.settings.garment, self.settings.body = cloth, body
        self.animate()
        self.assertTrue(self.settings.status.startswith("Verdict: pass"), self.settings.status + self.settings.details)
        self.assertEqual(self.scene.frame_current, self.scene.frame_start)
        # The body went out as Blender shows it, all modifiers on it.
        motion = scenes.samples(self.run_of("Cloth", "motion") / "inputs/body.pc2")
        self.assertEqual(len(motion), scenes.FRAMES)
        self.assertGreater(motion.shape[1], 4 * len(body.data.vertices))  # mirrored and subdivided
        for k in range(scenes.FRAMES):
            self.scene.frame_set(self.scene.frame_start + k)
            self.assertLess(np.abs(scenes.y_up(scenes.world_points(body)) - motion[k]).max(), 1e-6)
        self.assertGreater((motion[-1] - motion[0])[:, 1].max(), 0.09)
        # The cloth came back to every vertex in every frame.
        cache = self.run_of("Cloth", "motion") / "run/cloth.pc2"
        self.assertEqual(len(scenes.samples(cache)), scenes.FRAMES)
        worst = scenes.farthest(cloth, cache, self.scene.frame_start)
        print(f"farthest vertex from the cache: {worst:.2g} m")
        self.assertLess(worst, 1e-6)
        self.assertEqual([m.type for m in cloth.modifiers], ["MESH_CACHE", "SUBSURF"])
        # What it moves with: dressed first, then lifted.
        dressed = scenes.samples(self.run_of("Cloth", "dress") / "run/cloth.pc2")
        moved = scenes.samples(cache)
        self.assertEqual(np.abs(moved[0] - dressed[-1]).max(), 0)
        self.assertGreater(moved[-1][:, 1].max() - moved[0][:, 1].max(), 0.05)

    def test_a_rest_pose_is_dressed_and_led_into_the_first_frame(self):
        body, rig = scenes.body_with_armature()
        rig.pose.bones["hip"].location[0] = 0.05  # not keyed: another pose than at rest, in all frames
        bpy.context.view_layer.update()
        cloth = scenes.cloth_sheet()
        self.settings.garment, self.settings.body = cloth, body
        self.settings.start_pose, self.settings.lead_frames = "REST", 8
        self.animate()
        self.assertEqual(rig.data.pose_position, "POSE")
        folder = self.run_of("Cloth", "motion")
        motion = scenes.samples(folder / "inputs/body.pc2")
        self.assertEqual(len(motion), scenes.FRAMES + 8)
        rig.data.pose_position = "REST"
        bpy.context.view_layer.update()
        self.assertLess(np.abs(scenes.y_up(scenes.world_points(body)) - motion[0]).max(), 1e-6)
        rig.data.pose_position = "POSE"
        self.scene.frame_set(self.scene.frame_start)
        self.assertLess(np.abs(scenes.y_up(scenes.world_points(body)) - motion[8]).max(), 1e-6)
        self.assertEqual(len(scenes.samples(folder / "run/cloth.pc2")), scenes.FRAMES + 8)
        self.assertLess(scenes.farthest(cloth, folder / "run/cloth.pc2", self.scene.frame_start - 8), 1e-6)

    def test_pins_hold_and_follow(self):
        cloth = scenes.cloth_sheet(group="Pins", height=2.0)
        cloth.modifiers.new("Hook me", "DISPLACE")  # a modifier that deforms: above, or refused
        self.settings.garment = cloth
        self.assertIn("move it above 'Subdivision'", self.refused(bpy.ops.toile.dress))
        cloth.modifiers.remove(cloth.modifiers["Hook me"])
        bpy.ops.toile.add_pin()
        self.settings.pins[0].group = "Pins"
        self.scene.frame_set(self.scene.frame_start)
        start = scenes.y_up(np.array([cloth.matrix_world @ v.co for v in cloth.data.vertices]))
        held = [v.index for v in cloth.data.vertices if any(g.weight == 1 for g in v.groups)]
        self.animate()
        moved = scenes.samples(self.run_of("Cloth", "motion") / "run/cloth.pc2")
        self.assertEqual(len(moved), scenes.FRAMES)
        self.assertLess(np.abs(moved[:, held] - start[held]).max(), 2e-7)
        free = np.setdiff1d(np.arange(len(start)), held)
        self.assertGreater(np.abs(moved[-1][free] - start[free]).max(axis=1).min(), 1e-4)  # light ones are not held
        # Follow Object: a keyed location takes them along.
        for frame, x in ((self.scene.frame_start, 0.0), (self.scene.frame_end, 0.2)):
            cloth.location.x = x
            cloth.keyframe_insert("location", frame=frame)
        self.settings.pins[0].hold = "path"
        self.animate()
        led = scenes.samples(self.run_of("Cloth", "motion") / "run/cloth.pc2")
        self.assertAlmostEqual(float((led[-1] - led[0])[held, 0].mean()), 0.2, places=5)
        for k in (0, 4, scenes.FRAMES - 1):
            self.scene.frame_set(self.scene.frame_start + k)
            here = scenes.y_up(np.array([cloth.matrix_world @ v.co for v in cloth.data.vertices]))
            self.assertLess(np.abs(led[k][held] - here[held]).max(), 1e-6)
        # The object moves, and each vertex is where the cache has it nevertheless.
        self.assertLess(scenes.farthest(cloth, self.run_of("Cloth", "motion") / "run/cloth.pc2", self.scene.frame_start), 1e-6)
        self.settings.pins[0].group = "nobody"
        self.assertIn("no vertex group 'nobody'", self.refused(bpy.ops.toile.dress))

    def test_pins_on_the_body(self):
        body, _ = scenes.body_with_armature()
        cloth = scenes.cloth_sheet(height=1.31)
        middle = cloth.vertex_groups.new(name="Middle")
        centre = [v.index for v in cloth.data.vertices if v.co.length < 0.1]
        middle.add(centre, 1.0, "REPLACE")
        self.settings.garment, self.settings.body = cloth, body
        bpy.ops.toile.add_pin()
        self.settings.pins[0].group, self.settings.pins[0].hold = "Middle", "body"
        self.animate()
        motion = scenes.samples(self.run_of("Cloth", "motion") / "inputs/body.pc2")
        moved = scenes.samples(self.run_of("Cloth", "motion") / "run/cloth.pc2")
        top = int(np.argmax(motion[0][:, 1]))
        self.assertLess(np.abs((moved[-1] - moved[0])[centre].mean(axis=0) - (motion[-1] - motion[0])[top]).max(), 0.02)

    def test_split_vertices_and_loose_ones(self):
        """As an importer leaves a garment with a seam in its UV map."""
        cloth = scenes.cloth_sheet(cells=4)
        mesh = cloth.data
        bm_vertices = [tuple(v.co) for v in mesh.vertices]
        faces = [tuple(p.vertices) for p in mesh.polygons]
        seam = [k for k, co in enumerate(bm_vertices) if co[0] == 0]
        twin = {v: len(bm_vertices) + k for k, v in enumerate(seam)}
        right = [f for f in faces if sum(bm_vertices[v][0] for v in f) > 0]
        faces = [tuple(twin.get(v, v) for v in f) if f in right else f for f in faces]
        split = bpy.data.meshes.new("split")
        split.from_pydata([*bm_vertices, *(bm_vertices[v] for v in seam), (0.0, 0.0, 0.2)], [], faces)
        cloth.data = split
        body, _ = scenes.body_with_armature()
        self.settings.garment, self.settings.body = cloth, body
        self.dress()
        cache = self.run_of("Cloth", "dress") / "run/cloth.pc2"
        self.assertEqual(scenes.samples(cache).shape[1], len(bm_vertices))
        self.scene.frame_set(self.scene.frame_start)
        cloth.modifiers["Subdivision"].show_viewport = False
        shown = scenes.y_up(scenes.world_points(cloth))
        last = scenes.samples(cache)[-1]
        self.assertLess(np.abs(shown[: len(bm_vertices)] - last).max(), 1e-6)
        self.assertEqual(np.abs(shown[seam] - shown[[twin[v] for v in seam]]).max(), 0)

    def test_a_pattern_is_dressed_and_goes_with_the_body(self):
        out = self.folder / "demo"
        subprocess.run([program, "demo", "skirt", "--resolution", "4", "--seconds", "0.1", "--no-preview", "--quiet", "--out", out], check=False)
        self.scene.render.fps = 60
        self.assertEqual(bpy.ops.toile.load_run(directory=str(out)), {"FINISHED"})
        self.assertEqual((self.scene.render.fps, self.scene.render.fps_base), (30, 1))  # the rate of the run
        cloth, body = bpy.data.objects["demo.cloth"], bpy.data.objects["demo.body"]
        for obj, name in ((cloth, "cloth"), (body, "body")):
            self.assertLess(scenes.farthest(obj, out / f"{name}.pc2", self.scene.frame_start), 1e-6)
        self.assertGreater(len(cloth.data.materials), 1)  # one per panel
        cloth.hide_viewport = True
        self.scene.frame_end = self.scene.frame_start + 5
        for frame, x in ((self.scene.frame_start, 0.0), (self.scene.frame_end, 0.05)):
            body.location.x = x
            body.keyframe_insert("location", frame=frame)
        self.settings.source, self.settings.pattern = "PATTERN", str(source / "patterns/skirt.json")
        self.settings.body, self.settings.resolution_cm = body, 4
        self.dress()
        skirt = self.settings.result
        run = self.run_of("skirt", "dress") / "run"
        dressed = scenes.samples(run / "cloth.pc2")
        self.assertLess(scenes.farthest(skirt, run / "cloth.pc2", self.scene.frame_start - len(dressed) + 1), 1e-6)
        self.assertTrue(self.settings.status.startswith("Verdict: "), self.settings.status)
        top = skirt.vertex_groups.new(name="Waist")
        top.add(np.argsort(dressed[-1][:, 1])[-20:].tolist(), 1.0, "REPLACE")
        bpy.ops.toile.add_pin()
        self.settings.pins[0].group, self.settings.pins[0].hold = "Waist", "body"
        self.animate()
        self.assertEqual(self.settings.result, skirt)
        self.assertIn("Waist", skirt.vertex_groups)
        moved = scenes.samples(self.run_of("skirt", "motion") / "run/cloth.pc2")
        self.assertEqual(len(moved), 6)
        self.assertLess(scenes.farthest(skirt, self.run_of("skirt", "motion") / "run/cloth.pc2", self.scene.frame_start), 1e-6)
        waist = [v.index for v in skirt.data.vertices if any(g.group == top.index for g in v.groups)]
        self.assertAlmostEqual(float((moved[-1] - moved[0])[waist, 0].mean()), 0.05, places=3)

    def test_a_garmentcode_shirt_on_its_body(self):
        """A body of others, imported by Blender, bends over by an armature."""
        data = source.parent / "shared/data"
        mesh, pattern = data / "bodies/garmentcode/mean_all.obj", data / "patterns/garmentcode/shirt_mean_specification.json"
        if not (mesh.is_file() and pattern.is_file()):
            self.skipTest(f"there is no {data}")
        bpy.ops.wm.obj_import(filepath=str(mesh))
        body = bpy.context.selected_objects[0]
        scenes.bend_over(body, hip_m=0.95, neck_m=1.4, degrees=25)
        self.settings.source, self.settings.pattern, self.settings.body = "PATTERN", str(pattern), body
        self.settings.resolution_cm, self.settings.threads = 3, 0
        self.animate()
        shirt, run = self.settings.result, self.run_of("shirt_mean", "motion") / "run"
        self.assertEqual(shirt.name, "shirt_mean")
        self.assertEqual(len(scenes.samples(run / "cloth.pc2")), scenes.FRAMES)
        self.assertLess(scenes.farthest(shirt, run / "cloth.pc2", self.scene.frame_start), 1e-6)
        moved = scenes.samples(run / "cloth.pc2")
        self.assertGreater((moved[-1] - moved[0])[:, 2].max(), 0.1)  # forwards
        print(f"{self.settings.status}\n{self.settings.details}")

    def test_crossings_are_selected(self):
        """The middle is pinned inside the body: cloth passes through its skin all round."""
        cloth = scenes.cloth_sheet(cells=8, height=1.27)
        middle = cloth.vertex_groups.new(name="Middle")
        middle.add([v.index for v in cloth.data.vertices if v.co.length < 0.02], 1.0, "REPLACE")
        body, _ = scenes.body_with_armature()
        self.settings.garment, self.settings.body = cloth, body
        self.assertFalse(bpy.ops.toile.select_crossings.poll())
        bpy.ops.toile.add_pin()
        self.settings.pins[0].group = "Middle"
        self.dress()
        self.assertIn("cloth_body_intersection", self.settings.status)
        audit = json.loads((self.run_of("Cloth", "dress") / "audit.json").read_text())
        expected = {v for c in audit["worst_frame_crossings"] if c["edge_of"] == "cloth" for v in c["edge"]}
        self.assertGreater(len(expected), 2)
        bpy.ops.toile.select_crossings()
        selected = {v.index for v in cloth.data.vertices if v.select}
        self.assertLessEqual(expected, selected)
        self.assertLess(len(selected), 40)
        group = cloth.vertex_groups["Toile crossings"].index
        self.assertEqual({v.index for v in cloth.data.vertices if any(g.group == group for g in v.groups)}, selected)
        self.assertEqual(self.scene.frame_current, int(cloth.modifiers["Toile"].frame_start) + audit["worst_frame"])
        bpy.ops.toile.clear()
        self.assertNotIn("Toile", cloth.modifiers)

    def test_colliders_carry_the_cloth(self):
        """No body: a box rises, with a modifier; the garment is in the collection, too, and no collider."""
        box = scenes.link("Box", bpy.data.meshes.new("Box"))
        box.data.from_pydata([(x, y, z) for x in (-0.3, 0.3) for y in (-0.3, 0.3) for z in (0.9, 1.2)], [],
                             [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        box.modifiers.new("Bevel", "BEVEL").width = 0.02
        for frame, z in ((self.scene.frame_start, 0.0), (self.scene.frame_end, 0.15)):
            box.location.z = z
            box.keyframe_insert("location", frame=frame)
        props = bpy.data.collections.new("Props")
        self.scene.collection.children.link(props)
        cloth = scenes.cloth_sheet(height=1.22)
        for obj in (box, cloth):
            props.objects.link(obj)
        self.settings.garment, self.settings.solids = cloth, props
        self.animate()
        stage = self.run_of("Cloth", "motion")
        moved, solid = scenes.samples(stage / "run/cloth.pc2"), scenes.samples(stage / "inputs/solid_0.pc2")
        self.assertEqual(len(moved), scenes.FRAMES)
        self.assertFalse((stage / "inputs/solid_1.pc2").exists())  # the garment itself is none
        self.assertAlmostEqual(float(solid[-1][:, 1].max() - solid[0][:, 1].max()), 0.15, places=5)
        self.assertAlmostEqual(float(moved[-1][:, 1].max() - moved[0][:, 1].max()), 0.15, places=2)
        self.assertLess(scenes.farthest(cloth, stage / "run/cloth.pc2", self.scene.frame_start), 1e-6)

    def test_units_and_mirrored_objects(self):
        """A scene in centimetres, a garment and a body that are scaled by a negative number."""
        units = self.scene.unit_settings
        units.system, units.scale_length = "METRIC", 0.01
        body, _ = scenes.body_with_armature()
        cloth = scenes.cloth_sheet()
        parent = bpy.data.objects.new("Scale", None)
        self.scene.collection.objects.link(parent)
        parent.scale = (-100, 100, 100)
        for obj in (body, cloth):
            obj.parent = parent
        self.scene.gravity = (0, 0, -981)
        bpy.context.view_layer.update()
        self.settings.garment, self.settings.body = cloth, body
        self.dress()
        run = self.run_of("Cloth", "dress") / "run"
        last = scenes.samples(run / "cloth.pc2")[-1]
        self.assertLess(np.abs(last).max(), 2)  # metres
        self.assertLess(last[:, 1].min(), 1.3)
        self.scene.frame_set(self.scene.frame_start)
        cloth.modifiers["Subdivision"].show_viewport = False
        self.assertLess(np.abs(0.01 * scenes.y_up(scenes.world_points(cloth)) - last).max(), 1e-6)
