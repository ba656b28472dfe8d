"""The animation: what it draws, and that it leaves no half file."""

from __future__ import annotations

import sys
from types import SimpleNamespace

import drawn
import numpy as np
import pytest
from PIL import Image
from scipy.integrate import quad

from separatrix.errors import InputError
from separatrix.figures import animation, frames, scene
from separatrix.figures.animation import A_TURN, MOST_FRAMES, animate, frame_moments

SMALL = drawn.run(samples=4)


def at(data=SMALL, **options):
    """The scene of all samples."""
    return scene.scene(data, np.arange(data.sizes["time"]), **options)


@pytest.mark.parametrize(
    "data",
    [
        SMALL,
        drawn.run(samples=1, outcome="SETTLES"),
        drawn.run(samples=3, guidance="ball", touching=False),
        drawn.run(samples=2, count=1, guidance="inner"),
        drawn.run(samples=2, play=0.0, cage_land_out_of_round=1e-5),
        drawn.run(samples=2, count=100, outcome="STALLED"),
        drawn.run(samples=2, play=1e-2),
    ],
    ids=["ordinary", "one sample", "nothing touches", "one ball", "no play", "hundred balls", "a land only"],
)
def test_a_gif_is_written_for_any_run(data, tmp_path):
    """Each sample a frame here, told one by one; nothing else stays in the folder."""
    told = []
    animate(data, tmp_path / "a.gif", kind="gif", progress=lambda *args: told.append(args))
    assert [path.name for path in tmp_path.iterdir()] == ["a.gif"]
    count = data.sizes["time"]
    assert told == [(i + 1, count) for i in range(count)]
    with Image.open(tmp_path / "a.gif") as film:
        assert (film.n_frames, film.size) == (count, (760, 480))


def test_what_stands_still_is_white_and_colours_are_kept():
    """In a GIF; Pillow looks a colour up in cells of 8 of 256 steps."""
    drawn_colours = [tuple(round(255 * c) for c in animation.to_rgb(colour)) for colour in frames.DRAWN]
    image = Image.new("RGB", (len(drawn_colours) + 1, 1), "white")
    for place, colour in enumerate(drawn_colours):
        image.putpixel((place, 0), colour)
    kept = image.quantize(palette=animation.palette(), dither=Image.Dither.NONE).convert("RGB")
    wanted = np.asarray(image).astype(int)
    assert np.abs(np.asarray(kept).astype(int) - wanted).max() <= 8


def test_an_interrupt_leaves_no_half_file_and_the_older_one(tmp_path):
    """Ctrl-C at the second frame: the older film is there to the last byte, and nothing else."""
    (tmp_path / "a.gif").write_bytes(b"older")

    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(SMALL, tmp_path / "a.gif", kind="gif", progress=stop)
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"older"]


def test_an_unknown_kind_is_refused(tmp_path):
    """Before anything is written."""
    with pytest.raises(InputError, match="must be gif or mp4"):
        animate(SMALL, tmp_path / "a.avi", kind="avi")
    assert not list(tmp_path.iterdir())


def test_an_mp4_without_its_extra_says_what_to_install(tmp_path, monkeypatch):
    """One line, with the extra's name; nothing is written."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(InputError) as raised:
        animate(SMALL, tmp_path / "a.mp4", kind="mp4")
    assert "separatrix[animation]" in str(raised.value)
    assert "\n" not in str(raised.value)
    assert not list(tmp_path.iterdir())


def encoder(fail=None):
    """An encoder that writes what it is sent, or fails."""

    def write_frames(path, size, **options):
        with open(path, "wb") as file:
            while True:
                frame = yield
                if fail is not None:
                    raise fail
                file.write(frame)

    return SimpleNamespace(write_frames=write_frames)


def test_an_mp4_gets_every_frame(tmp_path, monkeypatch):
    """Three bytes for each point of each frame."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", encoder())
    animate(SMALL, tmp_path / "a.mp4", kind="mp4")
    assert (tmp_path / "a.mp4").stat().st_size == 4 * 3 * 760 * 480


def test_an_encoder_that_fails_leaves_one_line_and_no_file(tmp_path, monkeypatch):
    """A wheel without its program, or a full disk."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", encoder(OSError("no program\nat all")))
    with pytest.raises(InputError, match="could not be encoded") as raised:
        animate(SMALL, tmp_path / "a.mp4", kind="mp4")
    assert "\n" not in str(raised.value)
    assert not list(tmp_path.iterdir())


def test_the_ending_of_the_file_is_the_kind(tmp_path):
    """Unless a kind is given; no ending and another one are refused before anything is written."""
    for name in ("film", "film.avi"):
        with pytest.raises(InputError, match="must be gif or mp4") as raised:
            animate(SMALL, tmp_path / name)
        assert "\n" not in str(raised.value)
    assert not list(tmp_path.iterdir())
    animate(SMALL.isel(time=[0]), tmp_path / "film.GIF")
    assert (tmp_path / "film.GIF").read_bytes().startswith(b"GIF89a")


def whirling(samples, whirl):
    """A run of 10 ms whose centre turns at a frequency."""
    made = drawn.run(samples=samples)
    around = 2 * np.pi * whirl * made["time"].values
    return made.assign(velocity=(("time", "axis"), np.stack([np.cos(around), np.sin(around)], axis=1)))


def test_a_fast_whirl_is_never_strobed():
    """At least `A_TURN` frames a turn at the beginning and at the end; the picture says what is left out."""
    data = whirling(20_000, 50e3)
    moments = frame_moments(data)
    assert (moments[0], moments[-1]) == (0, 19_999)
    assert moments.size <= MOST_FRAMES
    steps = np.diff(data["time"].values[moments])
    assert (steps > 1 / (A_TURN * 50e3)).sum() == 1  # the cut
    (first, cut), (on, last) = frames.shown_parts(data, moments)
    assert (first, last) == pytest.approx((0.0, 10.0))
    assert cut < 1.0 < 9.0 < on
    assert "Shown: 0 to" in frames._notes(data, scene.scene(data, moments), moments)


def test_a_slow_whirl_is_shown_whole():
    """No cut where `MOST_FRAMES` show every turn."""
    data = whirling(20_000, 2e3)
    moments = frame_moments(data)
    assert len(frames.shown_parts(data, moments)) == 1
    assert np.diff(data["time"].values[moments]).max() < 1 / (A_TURN * 2e3)


def test_a_picture_says_how_many_times_too_large_movements_are():
    """Number for number, and how time runs."""
    at_all, moments = at(), np.arange(SMALL.sizes["time"])
    assert f"{at_all.enlarged:g} times" in frames._notes(SMALL, at_all, moments)
    dying = drawn.run(samples=40, outcome="SETTLES")
    assert "Logarithmic time" in frames._notes(dying, scene.scene(dying, np.arange(40)), np.arange(40))


@pytest.mark.parametrize("outcome", ["WHIRLS", "SETTLES"])
def test_frames_are_few_and_run_from_start_to_end(outcome):
    """However many samples: rising, with the first and the last."""
    moments = frame_moments(drawn.run(samples=5000, outcome=outcome))
    assert MOST_FRAMES / 2 < moments.size <= MOST_FRAMES
    assert (np.diff(moments) > 0).all()
    assert (moments[0], moments[-1]) == (0, 4999)


def test_a_wall_meets_its_ball_when_the_pocket_touches():
    """A cage moved by the play along the ball's tangent: bar and ball meet in the enlarged picture."""
    still = drawn.run(samples=1, count=13)
    moved = still.assign(position=still["position"] * 0.0 + [0.0, 3e-4])
    seen = at(moved)
    assert seen.enlarged > 2
    behind = scene.bars(seen, 0)[-1][8]  # the end of the bar behind ball 0, at its inner edge
    wall = seen.offset[0] + scene.ring(seen.radius, -seen.walls[0])
    assert wall[1] == pytest.approx(-seen.ball, rel=1e-9)  # tangent to the ball that lies at (R, 0)
    toward = np.arctan2(*(behind - seen.offset[0])[::-1])
    assert toward == pytest.approx(-seen.walls[0], rel=1e-9)


def test_the_cage_meets_its_land_when_it_touches():
    """At an offset of the gap the guided edge reaches the land, outside and inside."""
    for guidance, side in (("outer", 1), ("inner", -1)):
        data = drawn.run(samples=1, guidance=guidance)
        seen = at(data.assign(position=data["position"] * 0.0 + [5e-4, 0.0]))
        edge = scene.rails(seen, 0)[0 if side < 0 else 1]
        reached = np.hypot(*edge.T)
        farthest = reached.max() if side > 0 else reached.min()
        assert farthest == pytest.approx(scene.land_radius(seen), rel=1e-12)


def test_forces_push_the_cage_against_the_ball_forces():
    """N > 0 pushes the ball forward and the cage back; no force is no arrow; the land pushes inward."""
    data = drawn.run(samples=2, count=4)
    force = np.array([[0.0, 0, 0, 0], [4.0, 0, -1.0, 0]])
    seen = at(data.assign(contact_force=(("time", "ball"), force), land_force=("time", [0.0, 2.0])))
    _, along = scene.pocket_arrows(seen, 1)
    assert along[0] == pytest.approx([0.0, -1.0], abs=1e-12)
    assert along[2] == pytest.approx([0.0, -0.5], abs=1e-12)  # root of a quarter, forward at the far side
    assert np.isnan(along[[1, 3]]).all()
    foot, push = scene.land_arrow(seen, 1)
    assert push @ seen.offset[1] < 0
    assert np.isnan(scene.land_arrow(seen, 0)[1]).all()
    assert np.hypot(*foot) == pytest.approx(scene.land_radius(seen))


def test_the_ball_set_turns_by_the_integral_of_its_speed():
    """With a ramp from a fifth of the speed over 4 of 10 ms; without one, speed times time."""
    assert scene.turned_by(SMALL).tolist() == pytest.approx((600.0 * SMALL["time"].values).tolist())
    ramped = drawn.run(samples=6, cage_ramp_time=4e-3, cage_ramp_start=0.2)

    def speed(t):
        return 600.0 * (0.2 + 0.8 * min(t / 4e-3, 1.0))

    expected = [quad(speed, 0.0, t, points=[4e-3])[0] for t in ramped["time"].values]
    assert scene.turned_by(ramped).tolist() == pytest.approx(expected, rel=1e-9)  # quadrature


def test_in_the_fixed_frame_everything_turns_and_nothing_else_changes():
    """Balls, bars and arrows by the same angle."""
    turning, fixed = at(), at(fixed=True)
    angle = scene.turned_by(SMALL)[2]
    for part in (scene.ball_places, lambda s, m: np.concatenate(scene.bars(s, m))):
        assert scene.turned(part(turning, 2), angle) == pytest.approx(part(fixed, 2), abs=1e-12)


def test_without_a_study_the_ball_fills_three_quarters_of_its_place():
    """A dataset whose attributes were lost still makes a film."""
    bare = SMALL.drop_attrs()
    assert scene.ball_diameter(bare) == pytest.approx(0.75 * 2 * np.pi * 0.0325 / 5)
    assert scene.ball_diameter(SMALL) == 0.0111
