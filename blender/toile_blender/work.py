"""What the settings say, checked before anything is written."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Iterator

import bpy
import numpy as np

from . import evaluate, results
from .cloth_object import ClothObject
from .engine import axes, find_program, scene_file
from .engine.errors import ToileError
from .engine.stage import Stage
from .preferences import program
from .settings import ToileSettings


class Work:
    """Of one garment.  Data of Blender are looked up by name each time: an undo in between would leave a dangling one."""

    def __init__(self) -> None:
        self._scene = bpy.context.scene.name
        s = self.settings
        if s.source == "MESH" and s.garment is None:
            raise ToileError("choose the object that is to be cloth")
        if s.source == "PATTERN" and not s.pattern:
            raise ToileError("choose a sewing pattern")
        self.is_pattern = s.source == "PATTERN"
        self.pattern = Path(bpy.path.abspath(s.pattern)) if self.is_pattern else Path()
        if self.is_pattern and not self.pattern.is_file():
            raise ToileError(f"the pattern is not there: {self.pattern}")
        if self.is_pattern and s.body is None:
            raise ToileError("a pattern is sewn around a body: choose one")
        self._garment = "" if self.is_pattern else s.garment.name
        self._body = s.body.name if s.body is not None else ""
        if s.garment is not None and s.garment == s.body:
            raise ToileError("garment and body are the same object")
        meshes = s.solids.all_objects if s.solids is not None else []
        self._solids = sorted(o.name for o in meshes if o.type == "MESH" and o.name not in (self._garment, self._body) and o != s.result)
        self.name = self.pattern.stem.removesuffix("_specification") if self.is_pattern else self._garment
        self.program = program()
        self.version = find_program.version(self.program)
        self.fps = results.scene_rate(self.scene)
        self.start_frame, self.end_frame = self.scene.frame_start, self.scene.frame_end
        self.armatures = evaluate.armatures_of(self.garment, self.body) if s.start_pose == "REST" else []
        self.lead_frames = s.lead_frames if self.armatures else 0
        for what, obj in (("the garment", self.garment), *((what, obj) for what, _, obj in self.solid_objects())):
            if obj is not None:
                evaluate.check_shown(obj, self.scene, what)
        self.cloth = ClothObject(self.garment) if self.garment is not None else None
        self.dressed, self.moved = Stage(self.folder / "dress"), Stage(self.folder / "motion")

    @property
    def scene(self) -> bpy.types.Scene:
        scene = bpy.context.scene
        if scene.name != self._scene:
            raise ToileError(f"another scene is shown now: go back to '{self._scene}' and begin again")
        return scene

    @property
    def settings(self) -> ToileSettings:
        return self.scene.toile

    @property
    def garment(self) -> bpy.types.Object | None:
        return self._object(self._garment)

    @property
    def body(self) -> bpy.types.Object | None:
        return self._object(self._body)

    def _object(self, name: str) -> bpy.types.Object | None:
        if not name:
            return None
        obj = bpy.data.objects.get(name)
        if obj is None:
            raise ToileError(f"the object '{name}' is gone")
        return obj

    @property
    def folder(self) -> Path:
        """Of this garment."""
        setting = self.settings.folder or "//toile"
        if setting.startswith("//") and not bpy.data.is_saved:
            base = Path(bpy.app.tempdir) / "toile"  # goes away with Blender; the panel says so
        else:
            base = Path(bpy.path.abspath(setting))
        return base / bpy.path.clean_name(self.name)

    @property
    def world(self) -> scene_file.World:
        unit = evaluate.metres_per_unit(self.scene)
        gravity = np.array(self.scene.gravity) if self.scene.use_gravity else np.zeros(3)
        return scene_file.World(axes.to_toile(gravity, unit), axes.to_toile(np.array(self.settings.wind)))

    def garment_words(self, pins: list[scene_file.Pin]) -> scene_file.Garment:
        s = self.settings
        return scene_file.Garment(
            self.name,
            pattern=str(self.pattern.resolve()) if self.is_pattern else "",
            mesh="" if self.is_pattern else "cloth.obj",
            fabric=s.fabric,
            own_numbers=s.fabric_numbers.given(),
            pins=pins,
        )

    def solid_objects(self) -> list[tuple[str, str, bpy.types.Object]]:
        """(what it is to the user, name of its files, object): the body, if there is one, before the colliders."""
        body = [("the body", "body", self.body)] if self.body is not None else []
        return body + [("the collider", f"solid_{k}", self._object(name)) for k, name in enumerate(self._solids)]

    def around(self, moving: bool) -> scene_file.Around:
        s = self.settings
        solids = []
        for _, stem, _ in self.solid_objects():
            friction = s.body_friction if stem == "body" and s.use_body_friction else None
            solids.append(scene_file.Body(stem + ".obj", friction, stem + ".pc2" if moving else ""))
        body = solids.pop(0) if self._body else None
        return scene_file.Around(body, solids, self.world, self.fps)

    def options(self) -> list[str]:
        s = self.settings
        options = ["--quality", s.quality]
        if self.is_pattern and s.resolution_cm > 0:
            options += ["--resolution", f"{s.resolution_cm:.6g}"]
        return options

    def pins(self) -> list[tuple[str, str]]:
        return [(pin.group, pin.hold) for pin in self.settings.pins]

    @contextmanager
    def start_pose(self) -> Iterator[None]:
        """The first frame, or the rest pose."""
        shown = self.scene.frame_current, self.scene.frame_subframe
        with ExitStack() as stack:
            stack.callback(lambda: self.scene.frame_set(shown[0], subframe=shown[1]))
            self.scene.frame_set(self.start_frame)
            if self.armatures:
                stack.enter_context(evaluate.rest_pose(self.armatures))
            yield
