"""PC2 files."""

import struct

import numpy as np
import pytest

from toile_blender.engine import point_cache
from toile_blender.engine.errors import ToileError


def test_samples_come_back_to_the_bit(tmp_path):
    samples = np.random.default_rng(2).normal(size=(3, 5, 3)).astype(np.float32)
    with point_cache.Writer(tmp_path / "a.pc2", 5) as cache:
        for sample in samples:
            cache.add(sample)
    reader = point_cache.Reader(tmp_path / "a.pc2")
    assert (reader.points, reader.samples) == (5, 3)
    assert all(np.array_equal(reader.sample(k), samples[k]) for k in range(3))
    data = (tmp_path / "a.pc2").read_bytes()
    assert data[:12] == b"POINTCACHE2\0" and struct.unpack_from("<iiffi", data, 12) == (1, 5, 0.0, 1.0, 3)


def test_a_file_appears_when_it_is_complete(tmp_path):
    path = tmp_path / "a.pc2"
    with pytest.raises(RuntimeError):
        with point_cache.Writer(path, 1) as cache:
            cache.add(np.zeros((1, 3)))
            raise RuntimeError
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ToileError, match="expected 2 points in sample 0, got 1"):
        with point_cache.Writer(path, 2) as cache:
            cache.add(np.zeros((1, 3)))


def test_what_is_no_cache_is_told(tmp_path):
    path = tmp_path / "a.pc2"
    path.write_bytes(b"POINTCACHE1\0" + bytes(20))
    with pytest.raises(ToileError, match="a.pc2: expected a PC2 point cache"):
        point_cache.header(path)
    path.write_bytes(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 4, 0, 1, 2) + bytes(95))
    with pytest.raises(ToileError, match="expected 128 bytes .* got 127"):
        point_cache.Reader(path)
    assert point_cache.samples_so_far(path) == 2  # as the header of a growing file says
    assert point_cache.samples_so_far(tmp_path / "none.pc2") == 0
