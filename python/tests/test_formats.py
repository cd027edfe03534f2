"""Mesh files against trimesh, another reader and writer of them: what toile writes it reads, and what it writes toile reads."""

import numpy as np
import pytest
from conftest import sheet_arrays

import toile

trimesh = pytest.importorskip("trimesh")


@pytest.fixture(scope="module")
def two_panels(tmp_path_factory):
    """A run of a sheet of two panels; a seam of the drawing runs between them.  (folder, simulation)"""
    vertices, faces = sheet_arrays(cells=4)
    right = vertices[faces].mean(axis=1)[:, 0] > 0
    drawn = vertices[:, [0, 2]][faces] * [1, -1]
    drawn[right] += [0.5, 0.25]
    cloth = toile.Cloth(vertices, faces, uv_m=drawn, panel=right.astype(np.int32), panel_names=["left", "right"], name="sheet")
    cloth = cloth.set_panel_fabric("right", "denim")
    sim = toile.Simulation(cloth, "silk")
    folder = tmp_path_factory.mktemp("formats") / "run"
    with toile.RunWriter(folder, sim) as run:
        for _ in sim.frames(0.1, fps=30):
            run.add()
    return folder, sim


def corners(mesh, uv=None):
    """{(corners of a face, their uv)} whatever the order of faces and vertices is"""
    positions = np.asarray(mesh.vertices, dtype=np.float32)[mesh.faces]
    drawn = np.zeros(positions.shape[:2] + (2,)) if uv is None else np.asarray(uv)[mesh.faces]
    rows = np.concatenate([positions, np.round(drawn, 5) + 0.0], axis=-1)
    return {min(tuple(map(tuple, np.roll(face, k, axis=0).tolist())) for k in range(3)) for face in rows}


def expected_corners(sim, chosen):
    uv = np.stack([-sim.uv_m[..., 1], sim.uv_m[..., 0]], axis=-1)[chosen]  # vt: the weft to the right, the warp up
    rows = np.concatenate([sim.positions_m[sim.faces[chosen]].astype(np.float32), np.round(uv.astype(np.float32), 5) + 0.0], axis=-1)
    return {min(tuple(map(tuple, np.roll(face, k, axis=0).tolist())) for k in range(3)) for face in rows}


def close(left, right):
    """The same faces; uv may differ in their last digit."""
    left, right = (np.array(sorted(one)) for one in (left, right))
    return left.shape == right.shape and np.allclose(left, right, atol=3e-5)


def test_trimesh_reads_our_gltf(two_panels, tmp_path):
    folder, sim = two_panels
    (file,) = toile.export_run(folder, tmp_path / "sheet.glb")
    scene = trimesh.load(file, process=False)
    assert set(scene.geometry) == {"left", "right"}
    for number, name in enumerate(["left", "right"]):
        mesh = scene.geometry[name]
        assert close(corners(mesh, mesh.visual.uv), expected_corners(sim, sim.panel == number))
        assert mesh.visual.material.name == ["silk", "denim"][number]
        lengths = np.linalg.norm(mesh.vertex_normals, axis=1)
        assert np.allclose(lengths, 1, atol=1e-5)


def test_trimesh_reads_our_ply_and_obj(two_panels, tmp_path):
    folder, sim = two_panels
    everything = np.ones(len(sim.faces), dtype=bool)
    (file,) = toile.export_run(folder, tmp_path / "sheet.ply")
    mesh = trimesh.load(file, process=False)
    raw = mesh.metadata["_ply_raw"]
    uv = np.stack([raw["vertex"]["data"]["s"], raw["vertex"]["data"]["t"]], axis=-1).reshape(-1, 2)
    assert close(corners(mesh, uv), expected_corners(sim, everything))
    assert sorted(np.ravel(raw["face"]["data"]["panel"]).tolist()) == sorted(sim.panel.tolist())
    (file,) = toile.export_run(folder, tmp_path / "sheet.obj")
    mesh = trimesh.load(file, process=False)
    assert close(corners(mesh, mesh.visual.uv), expected_corners(sim, everything))


def test_every_frame_of_a_run(two_panels, tmp_path):
    folder, sim = two_panels
    files = toile.export_run(folder, tmp_path / "frames", to="ply", all=True)
    assert [file.rsplit("_", 1)[1] for file in files] == ["0000.ply", "0001.ply", "0002.ply", "0003.ply"]
    assert not np.allclose(trimesh.load(files[0]).vertices, trimesh.load(files[-1]).vertices)
    with pytest.raises(toile.InputError, match="frame"):
        toile.export_run(folder, tmp_path / "a.ply", frame=4)
    with pytest.raises(toile.Error, match="obj, ply, gltf, pc2, mdd or usda"):
        toile.export_run(folder, tmp_path / "a.fbx")


@pytest.mark.parametrize("ending", ["ply", "ascii.ply", "glb", "gltf", "obj"])
def test_we_read_bodies_of_trimesh(ending, tmp_path):
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.3)
    ball.unmerge_vertices()  # one vertex for each corner of each face
    path = tmp_path / f"ball.{ending}"
    if ending == "ascii.ply":
        path.write_bytes(trimesh.exchange.ply.export_ply(ball, encoding="ascii"))
    elif ending == "gltf":
        for name, content in trimesh.Scene({"ball": ball}).export(file_type="gltf").items():
            (tmp_path / name).write_bytes(content)
        (tmp_path / "model.gltf").rename(path)
    else:
        ball.export(path)
    vertices, faces = sheet_arrays(cells=2)
    body = toile.Body.from_file(path, unit="m")
    sim = toile.Simulation(toile.Cloth(vertices + [0, 0.5, 0], faces), "cotton", body)
    assert len(sim.body_faces) == 320 and len(sim.body_positions_m) == 162
    assert np.allclose(np.linalg.norm(sim.body_positions_m, axis=1), 0.3, atol=1e-5)


@pytest.mark.parametrize("ending", ["ply", "glb"])
def test_we_read_cloth_of_trimesh(ending, tmp_path):
    vertices, faces = sheet_arrays(cells=4)
    uv = vertices[:, [0, 2]] * [1, -1]
    sheet = trimesh.Trimesh(vertices, faces, visual=trimesh.visual.TextureVisuals(uv=uv), process=False)
    path = tmp_path / f"sheet.{ending}"
    sheet.export(path)
    sim = toile.Simulation(toile.Cloth.from_file(path), "silk")
    assert len(sim.positions_m) == len(vertices) and len(sim.faces) == len(faces)
    if ending == "glb":  # the drawing is taken: to rest it need not be laid out by face
        drawn = sim.uv_m
        assert np.allclose(np.ptp(drawn.reshape(-1, 2), axis=0), [0.16, 0.16], atol=1e-6)


def test_a_broken_file_is_an_input_error(tmp_path):
    path = tmp_path / "a.glb"
    path.write_bytes(b"glTF\x02\x00\x00\x00")
    with pytest.raises(toile.InputError, match="a.glb: header: expected 20 bytes, got 8"):
        toile.Simulation(toile.Cloth.from_file(path), "silk")
