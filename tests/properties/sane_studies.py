"""Random studies that an engineer could have written, each made by its seed: bearings of three classes."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from separatrix import Study, read_study


@dataclass(frozen=True, kw_only=True)
class Class:
    """Ranges of a class of bearings: a pair is (low, high), a tuple of names is a choice."""

    ball_diameter: tuple[float, float]  # [mm]
    contact_angle: tuple[float, float]  # [deg]
    conformity: tuple[float, float]
    dn: tuple[float, float]  # bore times speed [mm rpm]
    stribeck: tuple[float, float]  # load of a ball over its diameter^2 [N/mm2]; 1: some 0.9 GPa, 8: 1.8 GPa
    materials: tuple[tuple[str, str], ...]  # of balls and rings
    film: str
    thickness: tuple[float, float]  # [um]
    race_friction: tuple[float, float]
    environment: str  # lines of [operation]


CLASSES = {
    "turbopump": Class(
        ball_diameter=(6.0, 14.0), contact_angle=(15.0, 30.0), conformity=(0.515, 0.535), dn=(0.3e6, 2.0e6),
        stribeck=(2.0, 8.0), materials=(("440C", "440C"), ("Si3N4", "440C")), film="PTFE transfer film",
        thickness=(0.1, 1.0), race_friction=(0.05, 0.2),
        environment='temperature = "77 K"\nfluid = "liquid nitrogen"',
    ),
    "wheel": Class(
        ball_diameter=(3.0, 8.0), contact_angle=(12.0, 20.0), conformity=(0.52, 0.57), dn=(0.03e6, 0.25e6),
        stribeck=(0.2, 1.5), materials=(("52100", "52100"), ("440C", "440C")), film="MoS2 sputtered dense",
        thickness=(0.3, 1.5), race_friction=(0.02, 0.1), environment='temperature = "20 degC"',
    ),
    "gyro": Class(
        ball_diameter=(1.0, 3.2), contact_angle=(18.0, 35.0), conformity=(0.515, 0.56), dn=(0.05e6, 0.3e6),
        stribeck=(0.5, 3.0), materials=(("52100", "52100"), ("440C", "440C")), film="MoS2 sputtered dense",
        thickness=(0.3, 1.0), race_friction=(0.02, 0.1), environment='temperature = "60 degC"',
    ),
}  # fmt: skip


def sane_study(seed: int, folder: Path) -> Study:
    """The study of `sane_text`, read from a file that is written into a folder."""
    path = folder / f"sane-{seed}.toml"
    path.write_text(sane_text(seed), encoding="utf-8")
    return read_study(path)


def sane_text(seed: int, *, duration: str = "", runs: int = 0) -> str:
    """A study for `rank`: bearing, film, cage and two candidates, a smooth and a rough one.

    The same seed is the same text. `duration`, with its unit, and `runs` are the defaults of [stability] if
    they are absent; kicks always are.
    """
    rng = np.random.default_rng((17, seed))
    name = str(rng.choice(sorted(CLASSES)))
    one, ball = CLASSES[name], rng.uniform(*CLASSES[name].ball_diameter)
    count = int(rng.integers(8, 18))
    pitch = count * ball / (math.pi * rng.uniform(0.6, 0.8))  # balls fill 60 to 80 % of the pitch circle
    angle, bore = rng.uniform(*one.contact_angle), pitch - ball * rng.uniform(1.4, 1.8)
    axial = count * rng.uniform(*one.stribeck) * ball**2 * math.sin(math.radians(angle))
    radial = axial * rng.uniform(0.05, 0.4) if rng.random() < 0.5 else 0.0
    speed = math.copysign(rng.uniform(*one.dn) / bore, rng.random() - 0.15)
    balls, rings = one.materials[rng.integers(len(one.materials))]
    inner, outer = rng.uniform(*one.conformity), rng.uniform(*one.conformity)
    friction, thickness = rng.uniform(*one.race_friction), rng.uniform(*one.thickness)
    is_bare = rng.random() < 0.2
    settings = [f'duration = "{duration}"'] * bool(duration) + [f"runs = {runs}"] * bool(runs)
    return "\n".join(
        [
            f'title = "{name} bearing, seed {seed}"',
            "[bearing]",
            f'ball_diameter = "{ball:.4f} mm"',
            f'pitch_diameter = "{pitch:.3f} mm"',
            f"ball_count = {count}",
            f'contact_angle = "{angle:.2f} deg"',
            f"inner_conformity = {inner:.4f}",
            f"outer_conformity = {outer:.4f}",
            f'bore = "{bore:.3f} mm"',
            f'ball_material = "{balls}"',
            f'ring_material = "{rings}"',
            "[operation]",
            f'inner_speed = "{speed:.1f} rpm"',
            f'axial_load = "{axial:.3f} N"',
            *[f'radial_load = "{radial:.3f} N"'] * bool(radial),
            one.environment,
            "[film]",
            f"race_friction = {friction:.4f}",
            *([] if is_bare else [f'material = "{one.film}"', f'thickness = "{thickness:.3f} um"']),
            *_cage(ball, pitch, count, rng),
            *_candidates(one, rng),
            *(["[stability]", *settings] if settings else []),
            "",
        ]
    )


def _cage(ball: float, pitch: float, count: int, rng: np.random.Generator) -> list[str]:
    """A polymer ring of plausible section, less its pockets; plays of 1 to 5 % of a ball."""
    height, width = ball * rng.uniform(0.3, 0.5), ball * rng.uniform(1.5, 2.0)
    volume = math.pi * pitch * width * height - count * math.pi / 4.0 * ball**2 * height
    mass = volume * rng.uniform(1200.0, 2000.0) * 1e-6
    gap = pitch * math.sin(math.pi / count) - ball
    lines = [
        "[cage]",
        f'mass = "{mass:.5f} g"',
        f"material = {_polymer(rng)}",
        f'pocket_clearance = "{min(ball * rng.uniform(0.01, 0.05), gap / 3.0):.5f} mm"',
    ]
    shape, gravity = rng.choice(["square", "square", "cylindrical"]), rng.choice([0.0, 9.81])
    guidance = rng.choice(["outer", "inner", "ball"], p=[0.5, 0.35, 0.15])
    if guidance == "ball":  # with pockets that wrap round their balls
        shape = "spherical"
    lines += [f'pocket_shape = "{shape}"', f'gravity = "{gravity:g} m/s2"', f'guidance = "{guidance}"']
    if guidance == "ball":
        return lines
    return [
        *lines,
        f'land_clearance = "{ball * rng.uniform(0.01, 0.05):.5f} mm"',
        f"land_friction = {rng.uniform(0.05, 0.25):.3f}",
        f'land_stiffness = "{10 ** rng.uniform(6.0, 7.0):.4g} N/m"',
        f"land_restitution = {rng.uniform(0.3, 0.8):.2f}",
    ]


def _polymer(rng: np.random.Generator) -> str:
    modulus, ratio = 10 ** rng.uniform(0.3, 1.0), rng.uniform(0.3, 0.42)
    return f'{{ elastic_modulus = "{modulus:.2f} GPa", poisson_ratio = {ratio:.2f} }}'


def _candidates(of_class: Class, rng: np.random.Generator) -> list[str]:
    """Two materials, tested in one environment: the one of the study."""
    where = "liquid nitrogen, 440C" if "liquid nitrogen" in of_class.environment else "vacuum"
    lines: list[str] = []
    for name, low, high in (("smooth", 0.04, 0.15), ("rough", 0.2, 0.45)):
        mean = rng.uniform(low, high)
        test = f"{{ mean = {mean:.3f}, standard_deviation = {mean * 0.1:.4f}, count = 4 }}"
        lines += ["[[ranking.candidates]]", f'name = "{name}"', f'friction = {{ "{where}" = {test} }}']
        lines.append(f"material = {_polymer(rng)}")
    return lines
