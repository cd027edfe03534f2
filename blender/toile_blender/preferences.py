"""Where the program is."""

from pathlib import Path

import bpy
from bpy.props import StringProperty

from .engine import find_program
from .engine.errors import ToileError


class ToilePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program",
        subtype="FILE_PATH",
        description="The program `toile`, or its folder; empty: the one in PATH, else the one that came with the add-on",
    )

    def draw(self, _: bpy.types.Context) -> None:
        self.layout.prop(self, "program")
        try:
            self.layout.label(text=f"Used: {program()}", icon="CHECKMARK")
        except ToileError as error:
            self.layout.label(text=str(error), icon="ERROR")


def program() -> Path:
    addon = bpy.context.preferences.addons.get(__package__)
    preferred = addon.preferences.program if addon is not None and addon.preferences is not None else ""
    return find_program.find(bpy.path.abspath(preferred) if preferred else "")


classes = (ToilePreferences,)
