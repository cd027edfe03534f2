"""USD as usd-core reads it: what `toile export` writes, and the binary form that it makes of it."""

import numpy as np
import pytest
from conftest import sheet_arrays

import toile

pxr = pytest.importorskip("pxr", reason="needs usd-core (pip install usd-core)")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run of a falling sheet of two panels.  (folder, frames, simulation)"""
    vertices, faces = sheet_arrays(cells=4)
    right = vertices[faces].mean(axis=1)[:, 0] > 0
    drawn = vertices[:, [0, 2]][faces] * [1, -1]
    cloth = toile.Cloth(vertices, faces, uv_m=drawn, panel=right.astype(np.int32), panel_names=["left", "right half"], name="a sheet")
    sim = toile.Simulation(cloth, "silk")
    folder = tmp_path_factory.mktemp("usd") / "run"
    frames = []
    with toile.RunWriter(folder, sim, fps=25) as writer:
        for frame in sim.frames(0.2, fps=25):
            writer.add()
            frames.append(frame.positions_m.astype(np.float32))
    return folder, frames, sim


@pytest.mark.parametrize("ending", ["usda", "usdc"])
def test_usd_core_reads_every_frame(run, tmp_path, ending):
    from pxr import Usd, UsdGeom, UsdShade

    folder, frames, sim = run
    (file,) = toile.export_run(folder, tmp_path / f"sheet.{ending}")
    assert [path.name for path in tmp_path.iterdir()] == [f"sheet.{ending}"]
    stage = Usd.Stage.Open(file)
    assert stage.GetTimeCodesPerSecond() == 25
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Y"
    (mesh,) = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    assert mesh.GetPrim().GetName() == "a_sheet" and mesh.GetPrim().GetDisplayName() == "a sheet"
    written = len(mesh.GetPointsAttr().GetTimeSamples())
    assert written == len(frames) or written == len(frames) + 1  # with the start
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    rate = stage.GetTimeCodesPerSecond()
    samples = [np.array(mesh.GetPointsAttr().Get(time)) for time in range(written)]
    for wanted, got in zip(frames[::-1], samples[::-1]):
        assert sorted(map(tuple, got.tolist())) == sorted(map(tuple, wanted.tolist()))
    for time in range(written):
        speed = np.array(mesh.GetVelocitiesAttr().Get(time))
        before = min(time, written - 2)
        assert np.allclose(speed, (samples[before + 1] - samples[before]) * rate, atol=1e-4)
        assert np.allclose(np.linalg.norm(np.array(mesh.GetNormalsAttr().Get(time)), axis=1), 1, atol=1e-5)
        low, high = np.array(mesh.GetExtentAttr().Get(time))
        assert np.array_equal(low, samples[time].min(axis=0)) and np.array_equal(high, samples[time].max(axis=0))

    subsets = UsdGeom.Subset.GetAllGeomSubsets(mesh)
    assert [subset.GetPrim().GetDisplayName() for subset in subsets] == ["left", "right half"]
    assert UsdGeom.Subset.ValidateFamily(mesh, "face", "materialBind")[0]
    assert sorted(np.concatenate([subset.GetIndicesAttr().Get() for subset in subsets])) == list(range(len(corners)))
    for subset in subsets:
        material = UsdShade.MaterialBindingAPI(subset).ComputeBoundMaterial()[0]
        assert material and material.ComputeSurfaceSource()[0]

    st = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    assert st.GetInterpolation() == "faceVarying"
    drawn = np.array(st.ComputeFlattened()).reshape(-1, 3, 2)
    along, across = drawn[:, 1] - drawn[:, 0], drawn[:, 2] - drawn[:, 0]
    area = 0.5 * (along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0])
    assert np.allclose(area.sum(), np.prod(np.ptp(sim.uv_m.reshape(-1, 2), axis=0)), rtol=1e-4)


def test_usdc_says_what_it_needs_and_refuses_what_is_not_there(run, tmp_path):
    folder, frames, _ = run
    with pytest.raises(toile.InputError):
        toile.export_run(folder, tmp_path / "a.usdc", frame=99)
    assert not any(tmp_path.iterdir())
    (file,) = toile.export_run(folder, tmp_path / "b.usdc", frame=1)
    from pxr import Usd

    assert Usd.Stage.Open(file).GetEndTimeCode() == 0
