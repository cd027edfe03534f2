"""Dress and Animate, step by step: write what Toile reads, run it, take back what it wrote."""

from __future__ import annotations

import traceback
from contextlib import ExitStack
from pathlib import Path
from typing import Callable, Generator

import bpy
import numpy as np

from . import evaluate, results
from .cloth_object import Held
from .engine import obj_file, point_cache, pose_blend, run_files, scene_file
from .engine.errors import ToileError
from .engine.job import Job
from .engine.run_files import Progress
from .engine.stage import Stage
from .settings import ToileSettings
from .work import Work

Steps = Generator[Progress, None, None]


def dress(job: Job) -> Steps:
    """The garment comes to rest on the body as it stands."""
    work = Work()
    yield from _dress(job, work)
    _end_of_work()


def animate(job: Job) -> Steps:
    """The body moves from the first frame of the scene to the last; the garment is dressed before, where it is not."""
    work = Work()
    if work.end_frame <= work.start_frame:
        raise ToileError(f"the scene must have at least two frames, it has {work.start_frame} to {work.end_frame}")
    yield from _dress(job, work)
    if job.stopped:
        return
    verdict = run_files.verdict(work.dressed.run)
    if not verdict.reached_its_end:
        work.settings.status = f"Could not be dressed, so it is not moved. {work.settings.status}"
        return
    yield from _move(job, work)
    _end_of_work()


def _dress(job: Job, work: Work) -> Steps:
    yield Progress("writing garment and body")
    stage = work.dressed
    folder = stage.begin_inputs()
    pins: list[scene_file.Pin] = []
    with work.start_pose():
        _write_solids(work, folder)
        if work.cloth is not None:
            start = work.cloth.now(work.garment)
            obj_file.write(folder / "cloth.obj", "cloth", start, work.cloth.triangles, work.cloth.rest(work.settings.rest_shape, start))
            pins = Held(work.garment, work.cloth.particles, work.pins(), work.settings.pin_weight).pins(start, work.fps)
    scene = scene_file.dress_scene(work.garment_words(pins), work.around(moving=False))
    stage.end_inputs(scene, work.options(), work.version, [work.pattern] if work.is_pattern else [])
    yield from _run(job, work, stage, None)
    samples = point_cache.samples_so_far(stage.run / "cloth.pc2")
    # The last frame of the drape is the first frame of the scene, where the body is as it was dressed.
    yield from _take_back(job, work, stage, work.start_frame - max(samples - 1, 0))


def _move(job: Job, work: Work) -> Steps:
    stage = work.moved
    folder = stage.begin_inputs()
    start = point_cache.Reader(work.dressed.run / "cloth.pc2")
    at_rest = start.sample(start.samples - 1)
    if work.cloth is not None:
        held = Held(work.garment, work.cloth.particles, work.pins(), work.settings.pin_weight)
    else:
        held = Held(_result(work), np.arange(len(at_rest)), work.pins(), work.settings.pin_weight)
    blend = pose_blend.shares(work.lead_frames)
    yield from _write_motion(work, folder, held, blend)
    garment = work.garment_words(held.pins(at_rest, work.fps, blend))
    files = [work.dressed.run / "cloth.pc2"]
    if work.cloth is not None:
        drawn = work.cloth.rest(work.settings.rest_shape, _as_it_started(work))
        obj_file.write(folder / "cloth.obj", "cloth", at_rest, work.cloth.triangles, drawn)
    else:
        files.append(work.pattern)
    samples = work.lead_frames + work.end_frame - work.start_frame + 1
    scene = scene_file.motion_scene(garment, work.around(moving=True), samples, "" if work.cloth else str(work.dressed.run.resolve()))
    stage.end_inputs(scene, work.options(), work.version, files)
    yield from _run(job, work, stage, samples)
    yield from _take_back(job, work, stage, work.start_frame - work.lead_frames)


def _as_it_started(work: Work) -> np.ndarray:
    """Where the cloth was before it was dressed: what it rests as, if it rests as it starts."""
    with work.start_pose():
        return work.cloth.now(work.garment)


def _write_solids(work: Work, folder: Path) -> list[np.ndarray]:
    """The body and the colliders as they are now; their points."""
    written = []
    for what, stem, obj in work.solid_objects():
        points, corners = evaluate.evaluated(obj)
        if len(corners) == 0:
            raise ToileError(f"{what} '{obj.name}' has no faces")
        obj_file.write(folder / f"{stem}.obj", stem, points, corners)
        written.append(points)
    return written


def _write_motion(work: Work, folder: Path, held: Held, blend: np.ndarray) -> Steps:
    """Meshes and point caches of body and colliders, and the paths of pins that follow the object, for every frame of the scene."""
    frames = work.end_frame - work.start_frame + 1
    with work.start_pose():
        poses = _write_solids(work, folder)
        if held.leads:
            held.begin(_particles_now(work))
    shown = work.scene.frame_current, work.scene.frame_subframe
    with ExitStack() as stack:
        stack.callback(lambda: bpy.context.scene.frame_set(shown[0], subframe=shown[1]))
        caches = [
            stack.enter_context(point_cache.Writer(folder / f"{stem}.pc2", len(pose))) for (_, stem, _), pose in zip(work.solid_objects(), poses)
        ]
        for frame in range(work.start_frame, work.end_frame + 1):
            work.scene.frame_set(frame)
            for (what, _, obj), pose, cache in zip(work.solid_objects(), poses, caches):
                points, _ = evaluate.evaluated(obj)
                if len(points) != cache.points:
                    raise ToileError(
                        f"{what} '{obj.name}' has {len(points)} vertices at frame {frame} and {cache.points} where cloth is dressed: a modifier changes them"
                    )
                if frame == work.start_frame:
                    for share in blend:
                        cache.add(pose + np.float32(share) * (points - pose))
                cache.add(points)
            if held.leads:
                held.lead(_particles_now(work))
            done = frame - work.start_frame + 1
            yield Progress(f"writing frame {done} of {frames}", done / frames)


def _particles_now(work: Work) -> np.ndarray:
    """Where modifiers and transforms of the object have them at the frame that is shown."""
    if work.cloth is not None:
        return work.cloth.now(work.garment)
    obj = _result(work)
    with evaluate.only_deforming(obj):
        return evaluate.evaluated(obj)[0]


def _run(job: Job, work: Work, stage: Stage, samples: int | None) -> Steps:
    arguments = stage.command(work.options(), work.settings.threads)
    if arguments:
        yield from job.run(work.program, arguments, stage.folder, stage.output, lambda: run_files.progress(stage.run, samples))


def _take_back(job: Job, work: Work, stage: Stage, first_frame: int) -> Steps:
    """Cache, verdict and crossings."""
    settings = work.settings
    settings.run = results.as_blender_names(stage.run)
    cloth = stage.run / "cloth.pc2"
    if point_cache.samples_so_far(cloth) == 0:
        settings.status = "Stopped before the first frame" if job.stopped else "There are no frames"
        settings.details = ""
        if (stage.run / "report.json").is_file():
            _tell(settings, run_files.verdict(stage.run))
        return
    reader = point_cache.Reader(cloth)
    obj = work.garment if work.garment is not None else _sewn(work, stage)
    particles = work.cloth.particles if work.cloth is not None else np.arange(reader.points)
    expected = int(particles.max()) + 1
    if reader.points != expected:
        raise ToileError(
            f"'{obj.name}' has {expected} particles and the run {reader.points}: some of its vertices lie exactly on others. "
            "Mesh > Merge > By Distance, and dress it again"
        )
    if len(particles) != len(obj.data.vertices):
        raise ToileError(f"'{obj.name}' had {len(particles)} vertices when it was written and has {len(obj.data.vertices)} now: dress it again")
    np.save(stage.particles, particles)
    yield from results.write_cache(stage.cache, reader, particles, obj, first_frame)
    results.show_cache(obj, stage.cache, first_frame)
    work.scene.frame_set(work.start_frame)
    if job.stopped or not (stage.run / "report.json").is_file():
        settings.status, settings.details = f"Stopped after {reader.samples} frames", ""
        return
    verdict = run_files.verdict(stage.run)
    _tell(settings, verdict)
    if verdict.crossings > 0 and not stage.audit.is_file():
        yield from job.run(work.program, ["verify", str(stage.run), "--json"], stage.folder, stage.audit, lambda: Progress("looking for crossings"))


def _sewn(work: Work, stage: Stage) -> bpy.types.Object:
    made = results.new_object(work.name, stage.run / "cloth.obj", work.settings.result)
    work.settings.result = made
    return made


def _result(work: Work) -> bpy.types.Object:
    made = work.settings.result
    if made is None:
        raise ToileError("the garment that was sewn is gone: dress it again")
    return made


def _tell(settings: ToileSettings, verdict: run_files.Verdict) -> None:
    settings.status, settings.details = f"Verdict: {verdict.line}", "\n".join(verdict.details)


def _end_of_work() -> None:
    """One step of undo for all of it."""
    if not bpy.app.background:
        bpy.ops.ed.undo_push(message="Toile")


def guarded(steps: Callable[[Job], Steps]) -> Callable[[Job], Steps]:
    """An error of ours is a sentence for the user; everything else goes to the console as well."""

    def run(job: Job) -> Steps:
        try:
            yield from steps(job)
        except (ToileError, GeneratorExit):
            raise
        except Exception as error:
            traceback.print_exc()
            raise ToileError(f"an error of the add-on: {error} (the console has more)") from error

    return run
