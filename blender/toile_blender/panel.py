"""View3D > Sidebar > Toile."""

from __future__ import annotations

import textwrap

import bpy

from . import operators
from .engine import fabrics

_PIXELS_PER_CHARACTER, _MARGIN = 7.0, 55  # of Blender's font at its usual size; tabs, box and icon


def _wrapped(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "NONE") -> None:
    width = max(16, int((context.region.width / context.preferences.system.ui_scale - _MARGIN) / _PIXELS_PER_CHARACTER))
    column = layout.column(align=True)
    for line in text.splitlines():
        for part in textwrap.wrap(line, width) or [""]:
            column.label(text=part, icon=icon)
            icon = "NONE" if icon == "NONE" else "BLANK1"


class _Part:
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Toile"


class TOILE_UL_pins(bpy.types.UIList):
    def draw_item(self, context, layout, _data, item, _icon, _active, _property, _index=0, _flag=0) -> None:
        settings = context.scene.toile
        obj = settings.garment if settings.source == "MESH" else settings.result
        row = layout.row(align=True)
        if obj is not None:
            row.prop_search(item, "group", obj, "vertex_groups", text="")
        else:
            row.prop(item, "group", text="")
        row.prop(item, "hold", text="")


class TOILE_PT_main(_Part, bpy.types.Panel):
    bl_idname, bl_label = "TOILE_PT_main", "Toile"

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.toile, self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        layout.row().prop(settings, "source", expand=True)
        if settings.source == "MESH":
            layout.prop(settings, "garment")
        else:
            layout.prop(settings, "pattern")
        layout.prop(settings, "body")
        layout.prop(settings, "solids")
        layout.prop(settings, "fabric")
        layout.prop(settings, "quality")
        self._buttons(context)
        self._verdict(context)
        if settings.folder.startswith("//") and not bpy.data.is_saved:
            _wrapped(layout, context, "The file is not saved: caches go away when Blender is closed", "INFO")

    def _buttons(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if operators.running() and operators.current is not None:
            progress = operators.current.progress
            if progress.share is not None and hasattr(layout, "progress"):
                layout.progress(factor=progress.share, text=progress.words.capitalize())
            else:
                share = "" if progress.share is None else f"  ({100 * progress.share:.0f} %)"
                layout.label(text=progress.words.capitalize() + share, icon="TIME")
            layout.operator("toile.stop", icon="CANCEL")
            return
        row = layout.row(align=True)
        row.scale_y = 1.4
        row.operator("toile.dress", icon="MATCLOTH")
        row.operator("toile.animate", icon="PLAY")

    def _verdict(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.toile, self.layout
        if not settings.status or operators.running():
            return
        box = layout.box()
        good = settings.status.startswith("Verdict: pass")
        _wrapped(box, context, settings.status, "CHECKMARK" if good else "INFO" if settings.status.startswith("Stopped") else "ERROR")
        if settings.details:
            _wrapped(box, context, settings.details)
        row = box.row(align=True)
        row.operator("toile.select_crossings", icon="RESTRICT_SELECT_OFF")
        row.operator("toile.clear", icon="X", text="")


class TOILE_PT_pins(_Part, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id = "TOILE_PT_pins", "Pins", "TOILE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.toile, self.layout
        row = layout.row()
        row.template_list("TOILE_UL_pins", "", settings, "pins", settings, "active_pin", rows=2)
        column = row.column(align=True)
        column.operator("toile.add_pin", text="", icon="ADD")
        column.operator("toile.remove_pin", text="", icon="REMOVE")
        layout.prop(settings, "pin_weight")
        if settings.source == "PATTERN":
            _wrapped(layout, context, "Groups of the garment that was sewn; they hold from Animate on", "INFO")


class TOILE_PT_fabric(_Part, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id = "TOILE_PT_fabric", "Fabric", "TOILE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.toile, self.layout
        numbers = settings.fabric_numbers
        for number in fabrics.NUMBERS:
            row = layout.row(align=True)
            row.prop(numbers, "use_" + number.key, text=number.words)
            value = row.row()
            value.enabled = getattr(numbers, "use_" + number.key)
            value.prop(numbers, number.key, text="")
        if settings.source == "MESH":
            layout.prop(settings, "rest_shape")


class TOILE_PT_more(_Part, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id = "TOILE_PT_more", "More", "TOILE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.toile, self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        layout.prop(settings, "start_pose")
        if settings.start_pose == "REST":
            layout.prop(settings, "lead_frames")
        row = layout.row(heading="Friction on Body")
        row.prop(settings, "use_body_friction", text="")
        value = row.row()
        value.enabled = settings.use_body_friction
        value.prop(settings, "body_friction", text="")
        if settings.source == "PATTERN":
            layout.prop(settings, "resolution_cm")
        layout.prop(settings, "wind")
        layout.prop(settings, "threads")
        layout.prop(settings, "folder")
        layout.operator("toile.load_run", icon="FILE_FOLDER")


classes = (TOILE_UL_pins, TOILE_PT_main, TOILE_PT_pins, TOILE_PT_fabric, TOILE_PT_more)
