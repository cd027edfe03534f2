"""The buttons in a window: they return at once, Blender goes on meanwhile, Stop ends the program.

Usage: blender --factory-startup --python in_window.py -- ZIP PROGRAM SOURCE_ROOT [PICTURE.png]      on a display (Xvfb will do)
"""
import faulthandler
import os
import pathlib
import sys
import tempfile
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.dont_write_bytecode = True

import bpy  # noqa: E402
import scenes  # noqa: E402

arguments = sys.argv[sys.argv.index("--") + 1:]
archive, program = arguments[0], arguments[1]
picture = arguments[3] if len(arguments) > 3 else ""
LOOK_S = 0.05
faulthandler.dump_traceback_later(600, exit=True)  # a window that hangs


def prepared():
    if bpy.app.version >= (4, 2, 0):
        bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
        module = "bl_ext.user_default.toile_blender"
    else:
        bpy.ops.preferences.addon_install(filepath=archive, overwrite=True)
        bpy.ops.preferences.addon_enable(module="toile_blender")
        module = "toile_blender"
    bpy.context.preferences.addons[module].preferences.program = program
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 24
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            area.spaces.active.show_region_ui = bool(picture)
            area.spaces.active.shading.type = "SOLID" if picture else "WIREFRAME"
    body, _ = scenes.body_with_armature(lift_m=0.2)
    settings = scene.toile
    settings.garment, settings.body = scenes.cloth_sheet(cells=24), body
    settings.folder, settings.threads = tempfile.mkdtemp(prefix="toile_window_"), 1
    return sys.modules[module + ".operators"]


def in_the_view(call):
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        return call()


def is_alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def story(operators):
    """Yields where Blender is to go on."""
    assert in_the_view(lambda: bpy.ops.toile.animate("INVOKE_DEFAULT")) == {"RUNNING_MODAL"}
    assert not bpy.ops.toile.dress.poll() and bpy.ops.toile.stop.poll()
    words, looks = set(), 0
    while operators.running():
        words.add(operators.current.progress.words.replace(",", "").split()[0])
        yield
        looks += 1
        if picture and operators.current.progress.words.startswith("frame 2"):
            bpy.ops.screen.screenshot(filepath=picture)
    settings = bpy.context.scene.toile
    print(f"looked {looks} times, {sorted(words)}: {settings.status}")
    assert settings.status.startswith("Verdict: "), settings.status + settings.details
    assert looks > 10 and {"writing", "draping", "frame"} <= words, words
    settings.fabric = "denim"
    in_the_view(lambda: bpy.ops.toile.dress("INVOKE_DEFAULT"))
    while operators.current.pid is None:
        yield
    pid = operators.current.pid
    assert is_alive(pid)
    bpy.ops.toile.stop()
    while operators.running():
        yield
    assert not is_alive(pid) and settings.status.startswith("Stopped"), settings.status
    settings.fabric = "wool"
    in_the_view(lambda: bpy.ops.toile.dress("INVOKE_DEFAULT"))
    while operators.current.pid is None:
        yield
    pid = operators.current.pid
    bpy.ops.wm.read_homefile()
    yield
    assert not is_alive(pid) and not operators.running()


def look(steps=[]):  # noqa: B006: what is kept from call to call
    try:
        if not steps:
            steps.append(story(prepared()))
        next(steps[0])
        return LOOK_S
    except StopIteration:
        print("in a window: ok", flush=True)
        os._exit(0)
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)


bpy.app.timers.register(look, first_interval=1.0, persistent=True)  # another file is opened in between
