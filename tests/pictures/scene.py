"""A tree of primitives (`premio convert PART out.json`) written as a scene of POV-Ray, before a camera
given as OpenCV gives it.

The scene is scaled to a part of radius 100, since some of POV-Ray's tolerances are lengths: 1e-3 for
the start of a ray to a light.
"""

import math
from dataclasses import dataclass

import numpy

Tree = dict
Vector = numpy.ndarray

RADIUS = 100.0
# A light's colour at a millionth of its distance; see `light`.
NEAR = 1e-3
MERGED = {"union": "union", "intersection": "intersection", "difference": "difference"}


@dataclass
class Camera:
    """OpenCV's camera: pixels = K (R x + t), y down, pixel centres at integers."""

    k: Vector
    r: Vector
    t: Vector
    width: int
    height: int

    @property
    def eye(self) -> Vector:
        return -self.r.T @ self.t


@dataclass
class Light:
    """A point light: a white surface at `centre` that faces it has the brightness `share`."""

    position: Vector
    share: float


@dataclass
class Paint:
    """Brightnesses, where 1 is white under all lights: of a surface per incident light, of a surface
    without light, and of the background."""

    diffuse: float
    ambient: float
    background: float


def turned(axis: list[float], degrees: float) -> Vector:
    """The matrix of a rotation (Rodrigues)."""
    n = numpy.array(axis, float) / numpy.linalg.norm(axis)
    cross = numpy.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    angle = math.radians(degrees)
    return numpy.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * (cross @ cross)


def placed(node: Tree) -> str:
    """The transforms of a node, as one matrix."""
    rotation, shift = numpy.eye(3), numpy.zeros(3)
    for step in node.get("transform", []):
        if "translate" in step:
            shift = shift + numpy.array(step["translate"], float)
        elif "rotate" in step:
            turn = turned(*step["rotate"])
            rotation, shift = turn @ rotation, turn @ shift
        else:
            raise ValueError(f"an unknown transform: {step}")
    if not node.get("transform"):
        return ""
    # Its points are rows, so that the columns of a matrix are written one after another.
    return f"matrix <{numbers([*rotation.T.flatten(), *shift])}>"


def numbers(values) -> str:
    return ", ".join(f"{float(v):.17g}" for v in values)


def primitive(node: Tree) -> str:
    kind = node["prim"]
    if kind == "block":
        return f"box {{ <0, 0, 0>, <{numbers(node['size'])}> "
    if kind == "wedge":
        x, y, z = node["size"]
        # The half where x/X + z/Z <= 1.
        normal, far = [1 / x, 0, 1 / z], 1 / math.hypot(1 / x, 1 / z)
        box = f"box {{ <0, 0, 0>, <{numbers([x, y, z])}> }}"
        return f"intersection {{ {box} plane {{ <{numbers(normal)}>, {far:.17g} }} "
    if kind == "sphere":
        return f"sphere {{ <0, 0, 0>, {node['r']:.17g} "
    if kind == "cylinder":
        return f"cylinder {{ <0, 0, 0>, <0, 0, {node['h']:.17g}>, {node['r']:.17g} "
    if kind in ("cone", "frustum"):
        base, top = (node["r"], 0.0) if kind == "cone" else (node["r1"], node["r2"])
        return f"cone {{ <0, 0, 0>, {base:.17g}, <0, 0, {node['h']:.17g}>, {top:.17g} "
    if kind == "torus":
        # Its axis is y.
        return f"torus {{ {node['R']:.17g}, {node['r']:.17g} sturm rotate <90, 0, 0> "
    raise ValueError(f"an unknown primitive: {kind}")


def solid(node: Tree) -> str:
    """A node as an object; what it is made of is placed inside it."""
    if "prim" in node:
        start = primitive(node)
    else:
        children = [solid(child) for child in node["children"]]
        if len(children) == 1:
            start = f"object {{ {children[0]} "
        else:
            start = f"{MERGED[node['op']]} {{ {' '.join(children)} "
    return f"{start}{placed(node)} }}\n"


def camera(view: Camera, scale: float) -> str:
    """The camera by its vectors alone, so that no handedness comes in: a pixel (u, v) of n looks along
    direction + ((u + 1/2)/n - 1/2) right + (1/2 - (v + 1/2)/n) up."""
    fx, fy, cx, cy = view.k[0, 0], view.k[1, 1], view.k[0, 2], view.k[1, 2]
    x, y, z = view.r
    middle = [(view.width - 1) / 2, (view.height - 1) / 2]
    direction = z + x * (middle[0] - cx) / fx + y * (middle[1] - cy) / fy
    lines = [
        f"location <{numbers(view.eye * scale)}>",
        f"direction <{numbers(direction)}>",
        f"right <{numbers(x * view.width / fx)}>",
        f"up <{numbers(-y * view.height / fy)}>",
    ]
    return f"camera {{ perspective {' '.join(lines)} }}\n"


def light(source: Light, centre: Vector, scale: float) -> str:
    """POV-Ray's light fades by 2/(1 + (d/f)^2): with f far below all distances as 1/d^2."""
    distance = float(numpy.linalg.norm(source.position - centre)) * scale
    fade = NEAR * distance
    colour = source.share * (1 + (distance / fade) ** 2) / 2
    return (
        f"light_source {{ <{numbers(source.position * scale)}> rgb {colour:.17g} "
        f"fade_distance {fade:.17g} fade_power 2 }}\n"
    )


def scene(
    tree: Tree, view: Camera, lights: list[Light], paint: Paint, bounds: Vector, full: float
) -> str:
    """A whole scene; `full` is the brightness that is written as the greatest number of a picture."""
    centre = bounds.mean(axis=0)
    scale = RADIUS / (0.5 * float(numpy.linalg.norm(bounds[1] - bounds[0])))
    finish = (
        f"finish {{ ambient 0 diffuse {paint.diffuse / full:.17g} "
        f"emission {paint.ambient / full:.17g} brilliance 1 }}"
    )
    parts = [
        "#version 3.7;\n",
        "global_settings { assumed_gamma 1 ambient_light 0 max_trace_level 2 }\n",
        f"background {{ rgb {paint.background / full:.17g} }}\n",
        camera(view, scale),
        *(light(source, centre, scale) for source in lights),
        f"object {{ {solid(tree)} scale {scale:.17g} pigment {{ rgb 1 }} {finish} }}\n",
    ]
    return "".join(parts)
