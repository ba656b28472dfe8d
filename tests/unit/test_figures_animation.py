"""The film of a run: what it draws, when, and that it leaves no half file."""

from __future__ import annotations

import sys
from types import SimpleNamespace

import drawn
import numpy as np
import pytest
from PIL import Image
from scipy.integrate import quad

from separatrix.errors import InputError
from separatrix.figures import animation, motion, scene
from separatrix.figures.animation import animate
from separatrix.figures.motion import A_TURN, MOST_FRAMES, frame_moments

SMALL, LONG = drawn.run(samples=4), drawn.run(samples=5000)
SETTLING = drawn.run(samples=5000, outcome="SETTLES")
ODD = {
    "ordinary": SMALL,
    "one sample": drawn.run(samples=1, outcome="SETTLES"),
    "nothing touches": drawn.run(samples=3, guidance="ball", touching=False),
    "one ball": drawn.run(samples=2, count=1, guidance="inner"),
    "no play": drawn.run(samples=2, play=0.0, cage_land_out_of_round=1e-5),
    "hundred balls": drawn.run(samples=2, count=100, outcome="STALLED"),
    "a land only": drawn.run(samples=2, play=1e-2),
}


def with_film(data, **options):
    """The scene of all samples."""
    return scene.scene(data, np.arange(data.sizes["time"]), **options)


@pytest.mark.parametrize("data", ODD.values(), ids=ODD.keys())
def test_a_gif_is_written_for_any_run(data, tmp_path):
    """Each sample a frame here, reported one by one; nothing else stays in the folder."""
    reported = []
    animate(data, tmp_path / "a.gif", kind="gif", progress=lambda *args: reported.append(args))
    assert [path.name for path in tmp_path.iterdir()] == ["a.gif"]
    count = data.sizes["time"]
    assert reported == [(i + 1, count) for i in range(count)]
    with Image.open(tmp_path / "a.gif") as film:
        assert (film.n_frames, film.size) == (count, (760, 480))


def test_colours_of_a_gif_are_kept():
    """White and all that is drawn with."""
    colours = [tuple(round(255 * c) for c in animation.to_rgb(colour)) for colour in animation.DRAWN]
    image = Image.new("RGB", (len(colours) + 1, 1), "white")
    for place, colour in enumerate(colours):
        image.putpixel((place, 0), colour)
    kept = image.quantize(palette=animation.palette(), dither=Image.Dither.NONE).convert("RGB")
    # Pillow looks a colour up in cells of 8 of 256 steps
    assert np.abs(np.asarray(kept).astype(int) - np.asarray(image).astype(int)).max() <= 8


def test_an_interrupt_leaves_no_half_file_and_the_older_one(tmp_path):
    """Ctrl-C at the second frame: the older film is there to the last byte, and nothing else."""
    (tmp_path / "a.gif").write_bytes(b"older")

    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(SMALL, tmp_path / "a.gif", kind="gif", progress=stop)
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"older"]


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


@pytest.mark.parametrize(
    ("name", "kind", "installed", "words"),
    [
        ("a.avi", "avi", encoder(), "must be gif or mp4"),
        ("film", None, encoder(), "must be gif or mp4"),
        ("film.avi", None, encoder(), "must be gif or mp4"),
        ("a.mp4", "mp4", None, r"separatrix\[animation\]"),
        ("a.mp4", None, encoder(OSError("no program\nat all")), "could not be encoded"),
    ],
)
def test_what_cannot_be_written_is_refused_in_one_line(name, kind, installed, words, tmp_path, monkeypatch):
    """An unknown kind, an extra that is not installed, an encoder that fails: no file."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", installed)
    with pytest.raises(InputError, match=words) as raised:
        animate(SMALL, tmp_path / name, kind=kind)
    assert "\n" not in str(raised.value)
    assert not list(tmp_path.iterdir())


def test_the_ending_of_the_file_is_the_kind(tmp_path, monkeypatch):
    """An MP4 gets every frame, three bytes for each point; endings in capitals are known."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", encoder())
    animate(SMALL, tmp_path / "a.mp4")
    assert (tmp_path / "a.mp4").stat().st_size == 4 * 3 * 760 * 480
    animate(SMALL.isel(time=[0]), tmp_path / "film.GIF")
    assert (tmp_path / "film.GIF").read_bytes().startswith(b"GIF89a")


def whirling(samples, whirl):
    """A run of 10 ms whose centre turns at a frequency."""
    made = drawn.run(samples=samples)
    around = 2 * np.pi * whirl * made["time"].values
    return made.assign(velocity=(("time", "axis"), motion.ring(1.0, around)))


@pytest.mark.parametrize(("whirl", "parts"), [(50e3, 2), (2e3, 1)])
def test_a_fast_whirl_is_never_strobed(whirl, parts):
    """At least `A_TURN` frames a turn; a slow one is shown whole, else the picture says what is left out."""
    data = whirling(20_000, whirl)
    moments = frame_moments(data)
    steps, shown = np.diff(data["time"].values[moments]), animation.shown_parts(data, moments)
    assert (steps > 1 / (A_TURN * whirl)).sum() == parts - 1  # the cut
    assert len(shown) == parts
    assert (shown[0][0], shown[-1][1]) == pytest.approx((0.0, 10.0))
    assert animation.notes(data, scene.scene(data, moments), moments)[-1].startswith("Shown: 0 to")


@pytest.mark.parametrize("data", [*(whirling(20_000, whirl) for whirl in (50e3, 2e3)), LONG, SETTLING])
def test_frames_are_few_and_run_from_start_to_end(data):
    """However many samples: rising, with the first and the last."""
    moments = frame_moments(data)
    assert MOST_FRAMES / 2 < moments.size <= MOST_FRAMES
    assert (np.diff(moments) > 0).all()
    assert (moments[0], moments[-1]) == (0, data.sizes["time"] - 1)


def test_a_picture_says_how_many_times_too_large_movements_are():
    """Number for number, and how time runs."""
    seen, moments = with_film(SMALL), np.arange(SMALL.sizes["time"])
    assert f"{seen.enlarged:g} times" in animation.notes(SMALL, seen, moments)[0]
    assert animation.notes(SETTLING, with_film(SETTLING), np.arange(5000))[-1] == "Logarithmic time."


def test_a_wall_meets_its_ball_when_the_pocket_touches():
    """A cage moved by the play along the ball's tangent: bar and ball meet in the enlarged picture."""
    still = drawn.run(samples=1, count=13)
    seen = with_film(still.assign(position=still["position"] * 0.0 + [0.0, 3e-4]))
    assert seen.enlarged > 2
    behind = seen.bars(0)[-1][8]  # the end of the bar behind ball 0, at its inner edge
    wall = seen.offset[0] + scene.ring(seen.radius, -seen.walls[0])
    # rounding: tangent to the ball that lies at (R, 0)
    assert wall[1] == pytest.approx(-seen.ball, rel=1e-9)
    toward = np.arctan2(*(behind - seen.offset[0])[::-1])
    assert toward == pytest.approx(-seen.walls[0], rel=1e-9)


@pytest.mark.parametrize(("guidance", "side"), [("outer", 1), ("inner", -1)])
def test_the_cage_meets_its_land_when_it_touches(guidance, side):
    """At an offset of the gap the guided edge reaches the land, outside and inside."""
    data = drawn.run(samples=1, guidance=guidance)
    seen = with_film(data.assign(position=data["position"] * 0.0 + [5e-4, 0.0]))
    reached = np.hypot(*seen.rails(0)[0 if side < 0 else 1].T)
    farthest = reached.max() if side > 0 else reached.min()
    # rounding
    assert farthest == pytest.approx(seen.land, rel=1e-12)


def test_forces_push_the_cage_against_the_ball_forces():
    """N > 0 pushes the ball forward and the cage back; no force is no arrow; the land pushes inward."""
    data = drawn.run(samples=2, count=4)
    force = np.array([[0.0, 0, 0, 0], [4.0, 0, -1.0, 0]])
    seen = with_film(data.assign(contact_force=(("time", "ball"), force), land_force=("time", [0.0, 2.0])))
    _, along = seen.pocket_arrows(1)
    # rounding
    assert along[0] == pytest.approx([0.0, -1.0], abs=1e-12)
    # root of a quarter, forward at the far side
    assert along[2] == pytest.approx([0.0, -0.5], abs=1e-12)
    assert np.isnan(along[[1, 3]]).all()
    foot, push = seen.land_arrow(1)
    assert push @ seen.offset[1] < 0
    assert np.isnan(seen.land_arrow(0)[1]).all()
    assert np.hypot(*foot) == pytest.approx(seen.land)


def test_the_ball_set_turns_by_the_integral_of_its_speed():
    """With a ramp from a fifth of the speed over 4 of 10 ms; without one, speed times time."""
    assert scene.turned_by(SMALL).tolist() == pytest.approx((600.0 * SMALL["time"].values).tolist())
    ramped = drawn.run(samples=6, cage_ramp_time=4e-3, cage_ramp_start=0.2)

    def speed(t):
        return 600.0 * (0.2 + 0.8 * min(t / 4e-3, 1.0))

    expected = [quad(speed, 0.0, t, points=[4e-3])[0] for t in ramped["time"].values]
    # quadrature
    assert scene.turned_by(ramped).tolist() == pytest.approx(expected, rel=1e-9)


def test_in_the_fixed_frame_everything_turns_and_nothing_else_changes():
    """Balls and bars by the same angle."""
    turning, fixed, angle = with_film(SMALL), with_film(SMALL, fixed=True), scene.turned_by(SMALL)[2]
    for part in (lambda s: s.ball_places(2), lambda s: np.concatenate(s.bars(2))):
        # rounding
        assert scene.turned(part(turning), angle) == pytest.approx(part(fixed), abs=1e-12)


def test_without_a_study_the_ball_fills_three_quarters_of_its_place():
    """A dataset whose attributes were lost still makes a film."""
    assert with_film(SMALL.drop_attrs()).ball == pytest.approx(0.375 * 2 * np.pi * 0.0325 / 5)
    assert with_film(SMALL).ball == 0.5 * 0.0111
