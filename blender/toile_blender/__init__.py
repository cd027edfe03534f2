"""Toile in Blender: dress an object or a sewing pattern on a body, and let the body move.

Blender loads this file; `engine` needs no Blender.
"""

bl_info = {
    "name": "Toile",
    "author": "The authors of Toile",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > Toile",
    "description": "Dress animated bodies in sewing patterns and cloth meshes",
    "doc_url": "",
    "category": "Physics",
}


def register() -> None:
    from . import registration

    registration.register()


def unregister() -> None:
    from . import registration

    registration.unregister()
