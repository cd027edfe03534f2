"""What notebooks show by themselves, as IPython asks for it."""

import struct

import pytest
from conftest import has_pictures, level_sheet

import toile
from toile import _toile

draws = pytest.mark.skipif(not has_pictures(), reason="Toile is built without pictures")


def size_of(png: bytes) -> tuple[int, int]:
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", png[16:24])


@pytest.fixture
def drawn(monkeypatch):
    """How often something was drawn."""
    calls = []
    for name in ("picture_of_simulation", "picture_of_run"):
        monkeypatch.setattr(_toile, name, lambda *given, real=getattr(_toile, name), **view: (calls.append(1), real(*given, **view))[1])
    return calls


@draws
def test_a_simulation_is_drawn_when_asked_and_once_per_state(draped, drawn):
    assert not drawn, "nobody has asked"
    first = draped._repr_png_()
    assert size_of(first) == (480, 480) and len(first) < 1e6
    assert draped._repr_png_() is first and draped._repr_html_() is None
    assert len(drawn) == 1
    draped.advance(0.2)
    assert draped._repr_png_() != first and len(drawn) == 2
    draped.reset()
    assert draped._repr_png_() == first, "the same state, the same bits"


@draws
def test_panels_that_are_not_sewn_yet_and_several_garments_are_drawn():
    skirt = toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.04)
    both = toile.Simulation([skirt, toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.04).place((0, 0.3, 0)).set_name("other")])
    one = toile.Simulation([skirt, toile.Cloth.grid(width_m=0.2, height_m=0.2, edge_m=0.04).place((0, 0.3, 0)).set_name("same")])
    assert size_of(both._repr_png_()) == (480, 480)
    assert one._repr_png_() == both._repr_png_()
    front, back = both.picture(azimuth_deg=0), both.picture(azimuth_deg=180)
    assert front != back


@draws
def test_any_view_and_size(sheet):
    assert size_of(sheet.picture(width=60, height=40, azimuth_deg=180, elevation_deg=60, samples=2)) == (60, 40)
    with pytest.raises(toile.InputError, match="width, height"):
        sheet.picture(width=0)


@draws
def test_the_bits_do_not_depend_on_threads():
    pictures = {level_sheet(threads=threads).picture(width=80, height=80) for threads in (1, 3)}
    assert len(pictures) == 1


@draws
def test_a_run_shows_its_last_frame_and_its_verdict(draped, drawn, tmp_path):
    with toile.RunWriter(tmp_path / "run", draped, fps=30) as run:
        first = run._repr_png_()
        assert size_of(first) == (480, 480)
        assert "1 frames" in run._repr_html_()
        for _ in range(6):
            draped.advance(1 / 30)
            run.add()
        later = run._repr_png_()
        assert later != first and len(drawn) == 2
    draped.advance(0.2)
    assert run._repr_png_() is later, "what is written does not move on"
    shown = run._repr_html_()
    assert shown.startswith('<img src="data:image/png;base64,') and "pass" in shown
    assert len(drawn) == 2


def test_without_pictures_it_says_why(sheet, tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise toile.Error("built without pictures: <Embree>")

    monkeypatch.setattr(_toile, "picture_of_simulation", refuse)
    monkeypatch.setattr(_toile, "picture_of_run", refuse)
    run = toile.RunWriter(tmp_path / "run", sheet)
    for shown in (sheet, run):
        assert shown._repr_png_() is None
        text = shown._repr_html_()
        assert "No picture: built without pictures: &lt;Embree&gt;" in text and "<img" not in text
        assert repr(shown).replace("<", "&lt;").replace(">", "&gt;") in text
    with pytest.raises(toile.Error):
        sheet.picture()
