"""The buttons.  In Blender's window a job goes on by a timer; in scripts and in the background an operator returns when it is over."""

from pathlib import Path
from typing import Callable

import bpy
import numpy as np
from bpy.props import StringProperty

from . import results, steps
from .engine import obj_file, run_files
from .engine.errors import ToileError
from .engine.job import Job
from .evaluate import CACHE_MODIFIER

_TICK_S = 0.1

current: Job | None = None  # one at a time


def running() -> bool:
    return current is not None and not current.done


def begin(what: Callable[[Job], steps.Steps]) -> Job:
    global current
    if running():
        raise ToileError("Toile is at work already: stop it first")
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    current = Job(steps.guarded(what))
    return current


def abandon() -> None:
    """Before another file is opened, and when the add-on goes: nothing stays behind."""
    if current is not None:
        current.abandon()


class _JobOperator(bpy.types.Operator):
    bl_options = {"REGISTER"}
    _steps = staticmethod(steps.dress)
    _timer = None
    _told: run_files.Progress | None = None

    @classmethod
    def poll(cls, _: bpy.types.Context) -> bool:
        return not running()

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            job = begin(type(self)._steps)
        except ToileError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        job.finish()
        return self._over(context)

    def invoke(self, context: bpy.types.Context, _: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        try:
            begin(type(self)._steps)
        except ToileError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(_TICK_S, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        going_on = current is not None and current.tick()
        if going_on and current.progress != self._told:
            self._told = current.progress
            _redraw_sidebars(context)
        return {"PASS_THROUGH"} if going_on else self._over(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends, or another file is opened."""
        abandon()
        self._remove_timer(context)

    def _remove_timer(self, context: bpy.types.Context) -> None:
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None

    def _over(self, context: bpy.types.Context) -> set[str]:
        self._remove_timer(context)
        _redraw_sidebars(context)
        settings = context.scene.toile
        if current is None:
            return {"CANCELLED"}
        if current.error:
            settings.status, settings.details = "Not done", current.error
            self.report({"ERROR"}, current.error)
            return {"CANCELLED"}
        if current.stopped and not settings.status.startswith("Stopped"):
            settings.status, settings.details = "Stopped", ""
        good = settings.status.startswith("Verdict: pass")
        self.report({"INFO" if good or current.stopped else "WARNING"}, settings.status)
        return {"FINISHED"}


def _redraw_sidebars(context: bpy.types.Context) -> None:
    """Not the view itself, which may be heavy."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions:
                if area.type == "VIEW_3D" and region.type == "UI":
                    region.tag_redraw()


class TOILE_OT_dress(_JobOperator):
    bl_idname, bl_label = "toile.dress", "Dress"
    bl_description = "The garment comes to rest on the body as it is at the first frame"
    _steps = staticmethod(steps.dress)


class TOILE_OT_animate(_JobOperator):
    bl_idname, bl_label = "toile.animate", "Animate"
    bl_description = "The body moves through the frames of the scene, the garment with it. It is dressed before, where it is not"
    _steps = staticmethod(steps.animate)


class TOILE_OT_stop(bpy.types.Operator):
    bl_idname, bl_label = "toile.stop", "Stop"
    bl_description = "Ends the program within a second. What it has done is shown; pressed again, Dress or Animate go on from there"

    @classmethod
    def poll(cls, _: bpy.types.Context) -> bool:
        return running()

    def execute(self, _: bpy.types.Context) -> set[str]:
        if current is not None:
            current.stop()
        return {"FINISHED"}


class TOILE_OT_load_run(bpy.types.Operator):
    bl_idname, bl_label = "toile.load_run", "Load Run"
    bl_description = "Cloth and body of a folder that `toile` wrote; the scene gets its frame rate"
    bl_options = {"REGISTER", "UNDO"}

    directory: StringProperty(subtype="DIR_PATH")
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, _: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        run = Path(bpy.path.abspath(self.directory)).resolve()
        settings = context.scene.toile
        try:
            results.load_run(run)
            settings.run = results.as_blender_names(run)
            if (run / "report.json").is_file():
                verdict = run_files.verdict(run)
                settings.status, settings.details = f"Verdict: {verdict.line}", "\n".join(verdict.details)
        except ToileError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class TOILE_OT_select_crossings(bpy.types.Operator):
    bl_idname, bl_label = "toile.select_crossings", "Select Crossings"
    bl_description = "Goes to the frame in which most cloth passes through cloth or body, and selects its vertices; the group 'Toile crossings' keeps them"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        run = context.scene.toile.run
        return not running() and bool(run) and (_folder(run) / "audit.json").is_file()

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            found = _select_crossings(context)
        except (ToileError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{found} vertices" if found else "No cloth passes through anything")
        return {"FINISHED"}


def _folder(run: str) -> Path:
    """Of the stage that has this run."""
    return Path(bpy.path.abspath(run)).parent


def _select_crossings(context: bpy.types.Context) -> int:
    settings = context.scene.toile
    folder = _folder(settings.run)
    obj = settings.garment if settings.source == "MESH" else settings.result
    if obj is None or CACHE_MODIFIER not in obj.modifiers:
        raise ToileError("the garment of this run is not in the scene any more")
    cloth = obj_file.read(folder / "run/cloth.obj")
    crossings = run_files.crossings(folder / "audit.json", cloth.triangles.tolist())
    particles = np.load(folder / "particles.npy")
    if len(particles) != len(obj.data.vertices):
        raise ToileError(f"'{obj.name}' has {len(obj.data.vertices)} vertices and the run {len(particles)}: dress it again")
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    inside = np.isin(particles, np.array(crossings.vertices, dtype=np.int64)) & (particles >= 0)
    mesh = obj.data
    mesh.polygons.foreach_set("select", [False] * len(mesh.polygons))
    if bpy.app.version[:2] != (5, 0):  # 5.0.1 crashes where the selection of an edge is written
        mesh.edges.foreach_set("select", [False] * len(mesh.edges))
    mesh.vertices.foreach_set("select", inside.tolist())
    group = obj.vertex_groups.get("Toile crossings") or obj.vertex_groups.new(name="Toile crossings")
    group.remove(list(range(len(mesh.vertices))))
    group.add(np.flatnonzero(inside).tolist(), 1.0, "REPLACE")
    mesh.update()
    if crossings.frame >= 0:
        context.scene.frame_set(int(obj.modifiers[CACHE_MODIFIER].frame_start) + crossings.frame)
    for other in context.selected_objects:
        other.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj
    context.tool_settings.mesh_select_mode = (True, False, False)
    if not bpy.app.background:
        bpy.ops.object.mode_set(mode="EDIT")
    return int(inside.sum())


class TOILE_OT_clear(bpy.types.Operator):
    bl_idname, bl_label = "toile.clear", "Clear"
    bl_description = "Takes the cache off the garment: it is as it was modelled. Files stay"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return not running() and _shown(context) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        results.hide_cache(_shown(context))
        settings = context.scene.toile
        settings.status = settings.details = settings.run = ""
        return {"FINISHED"}


def _shown(context: bpy.types.Context) -> bpy.types.Object | None:
    settings = context.scene.toile
    obj = settings.garment if settings.source == "MESH" else settings.result
    return obj if obj is not None and CACHE_MODIFIER in obj.modifiers else None


class TOILE_OT_add_pin(bpy.types.Operator):
    bl_idname, bl_label = "toile.add_pin", "Add Pin"
    bl_description = "Holds the vertices of a group"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.toile
        obj = settings.garment if settings.source == "MESH" else settings.result
        pin = settings.pins.add()
        if obj is not None and obj.vertex_groups.active is not None:
            pin.group = obj.vertex_groups.active.name
        settings.active_pin = len(settings.pins) - 1
        return {"FINISHED"}


class TOILE_OT_remove_pin(bpy.types.Operator):
    bl_idname, bl_label = "toile.remove_pin", "Remove Pin"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return len(context.scene.toile.pins) > 0

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.toile
        settings.pins.remove(settings.active_pin)
        settings.active_pin = max(0, min(settings.active_pin, len(settings.pins) - 1))
        return {"FINISHED"}


classes = (
    TOILE_OT_dress,
    TOILE_OT_animate,
    TOILE_OT_stop,
    TOILE_OT_load_run,
    TOILE_OT_select_crossings,
    TOILE_OT_clear,
    TOILE_OT_add_pin,
    TOILE_OT_remove_pin,
)
