"""Setups: cameras and lights about a part, and the text that the program reads."""

import json
from dataclasses import dataclass, field

import numpy
from scene import Camera, Light

Vector = numpy.ndarray

# How far from the part's middle cameras and lights are, in its radius.
AWAY = (6, 9)
LIT_FROM = (3, 8)


@dataclass
class Conditions:
    """What all setups share. There is no specular term, which POV-Ray has in another form."""

    width: int = 640
    height: int = 480
    focal: float = 16.0
    film: tuple[float, float] = (8.8, 6.6)
    white: float = 200.0
    blur: float = 0.5
    electrons: float = 10000.0
    read_noise: float = 1.0
    # R_d in 1/sr, and R_a.
    diffuse: float = 0.25
    reflected: float = 0.3
    # There is no ambient light: the program has less of it where a face is hemmed in, and POV-Ray
    # everywhere the same.
    ambient: float = 0.0
    # 31 levels.
    background: float = 0.05
    detector: str = 'mask = "sobel"\nthreshold = 8.0\n'
    draws: int = 8

    def toml(self, seed: int, where: str) -> str:
        """The text that the program reads; `where` is the tables of cameras and lights."""
        return (
            f"seed = {seed}\nambient = {self.ambient!r}\nbackground = {self.background!r}\n"
            f"{where}"
            f"[material]\nambient = {self.reflected!r}\ndiffuse = {self.diffuse!r}\n"
            "s = 0\nd = 1\nm = 0.3\nn = 1.5\nk = 0\n"
            f"[sensor]\nfocal = {self.focal!r}\nfilm = {vector(self.film)}\n"
            f"resolution = [{self.width}, {self.height}]\nwhite = {self.white!r}\nblur = {self.blur!r}\n"
            f"electrons = {self.electrons!r}\nread_noise = {self.read_noise!r}\n"
            f"[detector]\n{self.detector}"
            f"[features]\ndraws = {self.draws}\n"
        )


@dataclass
class Setup:
    """A camera that looks from `eye` at `target` with z upwards, and lights of one strength in all."""

    eye: Vector
    target: Vector
    lights: list[Light] = field(default_factory=list)
    seed: int = 0

    def camera(self, conditions: Conditions) -> Camera:
        z = self.target - self.eye
        z = z / numpy.linalg.norm(z)
        x = numpy.cross(z, [0.0, 0.0, 1.0])
        x = x / numpy.linalg.norm(x)
        r = numpy.array([x, numpy.cross(z, x), z])
        size = (conditions.width, conditions.height)
        scale = [conditions.focal / conditions.film[i] * size[i] for i in (0, 1)]
        middle = [(n - 1) / 2 for n in size]
        k = numpy.array([[scale[0], 0, middle[0]], [0, scale[1], middle[1]], [0, 0, 1]])
        return Camera(k, r, -r @ self.eye, *size)

    def toml(self, conditions: Conditions) -> str:
        lights = [
            f"[[light]]\nposition = {vector(light.position)}\nparallel = {light.share / 2!r}\n"
            f"perpendicular = {light.share / 2!r}\n"
            for light in self.lights
        ]
        camera = f"[camera]\neye = {vector(self.eye)}\ntarget = {vector(self.target)}\n"
        return conditions.toml(self.seed, camera + "".join(lights))


def vector(values) -> str:
    return json.dumps([float(v) for v in values])


def direction(random: numpy.random.Generator) -> Vector:
    """Evenly over the sphere."""
    v = random.normal(size=3)
    return v / numpy.linalg.norm(v)


def setups(bounds: Vector, count: int, seed: int) -> list[Setup]:
    """Cameras all round, and one or two lights from the camera's side: a part of which all is dark
    says little."""
    random = numpy.random.default_rng(seed)
    centre = bounds.mean(axis=0)
    radius = 0.5 * float(numpy.linalg.norm(bounds[1] - bounds[0]))
    made = []
    for i in range(count):
        towards = direction(random)
        while abs(towards[2]) > 0.98:
            towards = direction(random)
        eye = centre + towards * radius * random.uniform(*AWAY)
        target = centre + direction(random) * radius * 0.15
        number = 1 + i % 2
        shares = [1.0] if number == 1 else [0.7, 0.3]
        lights = []
        for share in shares:
            along = direction(random)
            while along @ towards < 0.2:
                along = direction(random)
            lights.append(Light(centre + along * radius * random.uniform(*LIT_FROM), share))
        made.append(Setup(eye, target, lights, seed=1000 * seed + i))
    return made
