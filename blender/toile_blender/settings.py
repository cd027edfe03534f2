"""What the user says in the sidebar, kept in the scene."""

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty, StringProperty

from .engine import fabrics

# Newer versions want to be told that "//" is known; older ones do not know the word.
_RELATIVE = {"options": {"PATH_SUPPORTS_BLEND_RELATIVE"}} if bpy.app.version >= (4, 5, 0) else {}


def _is_mesh(_: object, obj: bpy.types.Object) -> bool:
    return obj.type == "MESH"


class ToilePin(bpy.types.PropertyGroup):
    group: StringProperty(name="Vertex Group", description="Its vertices are held")
    hold: EnumProperty(
        name="Hold",
        items=(
            ("fixed", "Where They Are", "They do not move"),
            ("path", "Follow Object", "They go where the object's own modifiers, shape keys and transforms take them"),
            ("body", "Follow Body", "They are carried by the nearest point of the body, and turn with it"),
        ),
    )


class ToileFabricNumbers(bpy.types.PropertyGroup):
    """A switch and a value for each number of a fabric."""

    __annotations__ = {}
    for _number in fabrics.NUMBERS:
        __annotations__["use_" + _number.key] = BoolProperty(name=_number.words, description="Instead of the preset's")
        __annotations__[_number.key] = FloatProperty(
            name=_number.words,
            description=_number.unit,
            default=_number.cotton,
            min=_number.least,
            max=_number.most,
            precision=6 if _number.least < _number.cotton < 0.001 else 4 if _number.cotton < 1 else 0,
        )
    del _number

    def given(self) -> dict[str, float]:
        # Seven digits are what a property keeps: 0.15 is not to become 0.15000000596.
        return {n.key: float(f"{getattr(self, n.key):.7g}") for n in fabrics.NUMBERS if getattr(self, "use_" + n.key)}


class ToileSettings(bpy.types.PropertyGroup):
    source: EnumProperty(
        name="Garment",
        items=(("MESH", "Object", "A garment that is modelled already, where it is worn"), ("PATTERN", "Pattern", "A GarmentCode JSON file")),
    )
    garment: PointerProperty(name="Object", type=bpy.types.Object, poll=_is_mesh, description="It becomes cloth")
    pattern: StringProperty(
        name="Pattern", subtype="FILE_PATH", description="Sewn around the body, which stands at the origin and looks along -Y", **_RELATIVE
    )
    result: PointerProperty(name="Result", type=bpy.types.Object, description="The garment that was sewn from the pattern")
    body: PointerProperty(name="Body", type=bpy.types.Object, poll=_is_mesh, description="A closed surface. Its modifiers and armature act, as in the viewport")
    solids: PointerProperty(name="Colliders", type=bpy.types.Collection, description="Its meshes are solids too, closed ones; they move as Blender moves them")
    use_body_friction: BoolProperty(name="Own Friction", description="Instead of the fabric's")
    body_friction: FloatProperty(name="Friction on Body", default=0.35, min=0, max=100)

    fabric: EnumProperty(name="Fabric", items=[(name, name.capitalize(), "") for name in fabrics.NAMES], default="cotton")
    fabric_numbers: PointerProperty(type=ToileFabricNumbers)
    rest_shape: EnumProperty(
        name="Rests as",
        items=(
            ("AUTOMATIC", "Automatic", "As drawn where the UV map is in metres, else as modelled"),
            ("DRAWING", "UV Map in Metres", "As it was cut: the UV map is the pattern, its second axis the warp"),
            ("MODELLED", "As Modelled", "The mesh without its modifiers"),
            ("START", "As It Starts", "The mesh with modifiers that deform it, at the first frame"),
        ),
    )
    pins: CollectionProperty(type=ToilePin)
    active_pin: IntProperty()
    pin_weight: FloatProperty(name="From Weight", default=0.5, min=0, max=1, description="Vertices of at least this weight are held")

    quality: EnumProperty(
        name="Quality",
        items=(
            ("draft", "Draft", "Steps of 33 ms; patterns with edges of 2 cm"),
            ("good", "Good", "Steps of 17 ms; patterns with edges of 1 cm"),
            ("final", "Final", "Steps of 8 ms; patterns with edges of 0.7 cm"),
        ),
        default="good",
    )
    resolution_cm: FloatProperty(name="Edges, cm", min=0, max=20, description="Of a pattern's triangles; 0: by quality")
    start_pose: EnumProperty(
        name="Dress on",
        items=(
            ("FRAME", "First Frame", "The body as it is at the first frame"),
            ("REST", "Rest Pose", "The rest pose of its armature, then moved into the first frame"),
        ),
    )
    lead_frames: IntProperty(name="Lead-In", default=30, min=1, max=1000, description="Frames from the rest pose to the first frame")
    wind: FloatVectorProperty(name="Wind, m/s", size=3, subtype="XYZ", soft_min=-20, soft_max=20)
    threads: IntProperty(name="Threads", min=0, max=1024, description="0: all; results do not depend on it")
    folder: StringProperty(
        name="Folder", subtype="DIR_PATH", default="//toile", description="Where runs and caches go; the caches are read from there", **_RELATIVE
    )

    status: StringProperty()
    details: StringProperty()
    run: StringProperty(name="Run", description="The folder of the last run")


classes = (ToilePin, ToileFabricNumbers, ToileSettings)
