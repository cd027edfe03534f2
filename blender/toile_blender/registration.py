"""What Blender is told when the add-on is switched on and off."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from . import operators, panel, preferences, settings

_classes = (*settings.classes, *preferences.classes, *operators.classes, *panel.classes)


@persistent
def _before_another_file(*_: object) -> None:
    operators.abandon()


def register() -> None:
    for cls in _classes:
        bpy.utils.register_class(cls)
    bpy.types.Scene.toile = bpy.props.PointerProperty(type=settings.ToileSettings)
    bpy.app.handlers.load_pre.append(_before_another_file)


def unregister() -> None:
    """Also when Blender ends."""
    operators.abandon()
    bpy.app.handlers.load_pre.remove(_before_another_file)
    del bpy.types.Scene.toile
    for cls in reversed(_classes):
        bpy.utils.unregister_class(cls)
