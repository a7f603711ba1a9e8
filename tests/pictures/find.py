"""Parts found in pictures of known solids: how many, how far off, how fast, and where they are not.

PREMIO_IMAGES names the folder of the pictures; every frame that is there is used. A part is looked for
in one picture at a time, with no initial pose, by its model over random light. Errors are of the part's
middle, in millimetres, and of its turn, modulo the turns that bring the part onto itself.

- castle_simu: the pose is exact. The tower is described as a block, which it nearly is: its top is open.
- teabox_stereo: left and right are found each on its own, and compared through the known extrinsic.
- cube_cylinder: only the first frame has a pose, good to 2 pixels.
- lego_square: no pose. Four bricks, with the gaps between them, and how light each is; their studs are
  not described.

A part that is not in a picture and is found there is a false accept; all pictures of other sets count,
but those of a cube for a cube: they are alike but for their distance. `--without` names a folder of
pictures in which none of the parts is.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy
from real import CUBE_IN_WORLD, rotation

Matrix = numpy.ndarray


def block(size: list[float], corner: list[float]) -> dict:
    return {"prim": "block", "size": size, "transform": [{"translate": corner}]}


def brick(x: float, y: float) -> dict:
    """A brick of two by four studs, of four in a square about a hole: where it lies along y, it lies at
    the right or the left end. What is 32 by 16 mm in the grid is 0.1 mm narrower on every side."""
    sides = [16, 32] if (x, y) in [(32, 0), (0, 16)] else [32, 16]
    return block([side - 0.2 for side in sides] + [9.6], [x + 0.1, y + 0.1, 0])


@dataclass
class Sought:
    """A part, and the pictures that it is in."""

    name: str
    description: dict
    folder: str
    # By camera: its matrix and the pattern of its pictures.
    cameras: dict[str, tuple[list[float], str]]
    # Its middle, and a turn by half about x, y and z if it has no more symmetry.
    middle: list[float]
    # Folders with pictures of what looks like it.
    alike: list[str] = field(default_factory=list)
    # Of its solids that are not all as light, the reflectance by the lowest x and y.
    shades: dict[tuple[float, float], float] = field(default_factory=dict)


TEABOX = {
    "left": ([680.0610, 680.8200, 338.1239, 247.1569], "left_*.png"),
    "right": ([682.2252, 682.1643, 320.0807, 225.3684], "right_*.png"),
}
CASTLE = {"": ([700, 700, 320, 240], "Image_*.png")}
TABLE = {"": ([547.7367575, 542.0744058, 338.7036994, 234.5083345], "image*.png")}
LEGO = {"": ([839.21470, 839.44555, 325.66776, 243.69727], "frame_*.png")}
PARTS = [
    Sought(
        "castle_simu: cube",
        block([100, 100, 100], [-50, -50, -50]),
        "castle_simu",
        CASTLE,
        [0, 0, 0],
        ["cube_cylinder"],
    ),
    Sought(
        "castle_simu: tower",
        block([80, 98, 82], [-40, 80.76, -43]),
        "castle_simu",
        CASTLE,
        [0, 129.76, -2],
        ["cube_cylinder"],
    ),
    Sought(
        "teabox_stereo",
        block([165, 68, 80], [0, 0, -80]),
        "teabox_stereo",
        TEABOX,
        [82.5, 34, -40],
    ),
    Sought(
        "cube_cylinder: cube",
        block([84, 84, 84], [-84, 0, 0]),
        "cube_cylinder",
        TABLE,
        [-42, 42, 42],
        ["castle_simu"],
    ),
    Sought(
        "cube_cylinder: cube and tube",
        {
            "op": "union",
            "children": [
                block([84, 84, 84], [-84, 0, 0]),
                {
                    "prim": "cylinder",
                    "r": 40,
                    "h": 250,
                    "transform": [{"translate": [-170, -30, 0]}],
                },
            ],
        },
        "cube_cylinder",
        TABLE,
        [-42, 42, 42],
    ),
    Sought(
        "lego_square",
        {"op": "union", "children": [brick(0, 0), brick(32, 0), brick(16, 32), brick(0, 16)]},
        "lego_square",
        LEGO,
        [24, 24, 4.8],
        # A bright one, two darker ones, and one as dark as the plate below, estimated by eye.
        shades={(0.1, 0.1): 0.3, (32.1, 0.1): 0.2, (16.1, 32.1): 0.12, (0.1, 16.1): 0.03},
    ),
]
SETUPS = """
background = 0.05
ambient = 0.5
[viewing]
count = 150
[illumination]
count = 4
[material]
diffuse = 0.25
ambient = 0.3
s = 0
d = 1
m = 0.3
n = 1.5
k = 0
[sensor]
resolution = [640, 480]
white = 200
blur = 0.5
electrons = 10000
read_noise = 1
[detector]
mask = { gaussian = { sigma = 1.0 } }
threshold = 4
low = 1.5
shortest = 10
"""


class Program:
    """The program, with a folder for its files."""

    def __init__(self, premio: str, folder: Path, options: list[str]):
        self.premio, self.folder, self.options = premio, folder, options

    def model(self, part: Sought) -> Path:
        stem = part.name.replace(" ", "").replace(":", "_")
        description = self.folder / f"{stem}.json"
        description.write_text(json.dumps(part.description))
        return self.learned(description, SETUPS + self.surfaces(description, part.shades))

    def surfaces(self, description: Path, shades: dict[tuple[float, float], float]) -> str:
        """The tables of a setup that say how light the faces of each solid are."""
        if not shades:
            return ""
        exported = self.folder / "boundary.json"
        self.run(["export", description, "--format", "json", "-o", exported])
        shells: dict[int, list[dict]] = {}
        for face in json.loads(exported.read_text())["faces"]:
            shells.setdefault(face["shell"], []).append(face)

        def lowest(faces: list[dict], axis: int) -> float:
            planes = [f["surface"] for f in faces]
            return min(p["origin"][axis] for p in planes if abs(p["normal"][axis]) > 0.5)

        tables = []
        for faces in shells.values():
            shade = shades[lowest(faces, 0), lowest(faces, 1)]
            material = f"{{ diffuse = {shade}, ambient = {shade}, s = 0, d = 1, m = 0.3, n = 1.5, k = 0 }}"
            tables.append(f"[[surface]]\nfaces = {[f['id'] for f in faces]}\nmaterial = {material}\n")
        return "".join(tables)

    def learned(self, description: Path, text: str) -> Path:
        setups, model = self.folder / "setups.toml", self.folder / f"{description.stem}.model"
        setups.write_text(text)
        self.run(["model", description, "--setups", setups, "-o", model])
        return model

    def match(
        self, model: Path, k: list[float], pictures: list[Path], options: list[str] | None = None
    ) -> list[dict]:
        camera, out = self.folder / "camera.json", self.folder / "poses.jsonl"
        matrix = [[k[0], 0, k[2]], [0, k[1], k[3]], [0, 0, 1]]
        camera.write_text(json.dumps({"K": matrix}))
        self.run(["match", model, *pictures, "--camera", camera, "-o", out, *self.options, *(options or [])])
        text = out.read_text()
        return [json.loads(text)] if len(pictures) == 1 else [*map(json.loads, text.splitlines())]

    def run(self, arguments: list) -> None:
        subprocess.run([self.premio, *map(str, arguments)], check=True, stderr=subprocess.DEVNULL)


def pose(found: dict) -> Matrix:
    m = numpy.eye(4)
    m[:3, :3], m[:3, 3] = found["R"], found["t"]
    return m


def poses(found: dict) -> list[Matrix]:
    return [pose(found), *map(pose, found["alternatives"])]


def error(found: dict, truth: Matrix, middle: list[float]) -> tuple[float, float]:
    """How far a pose is off, the nearest of those that are alike: of the middle, and in degrees."""

    def off(m: Matrix) -> tuple[float, float]:
        at = numpy.array([*middle, 1.0])
        cosine = (numpy.trace(m[:3, :3].T @ truth[:3, :3]) - 1) / 2
        turn = numpy.degrees(numpy.arccos(numpy.clip(cosine, -1, 1)))
        return float(numpy.linalg.norm((m @ at - truth @ at)[:3])), float(turn)

    return min(map(off, poses(found)), key=lambda e: e[0] + e[1])


def metres(m: Matrix) -> Matrix:
    """A pose in millimetres, of one in metres, with a rotation that is one."""
    u, _, v = numpy.linalg.svd(m[:3, :3])
    out = numpy.eye(4)
    out[:3, :3], out[:3, 3] = u @ v, 1000 * m[:3, 3]
    return out


def truths(part: Sought, folder: Path, frames: list[dict]) -> list[Matrix | None]:
    if part.folder == "castle_simu":
        cube = CUBE_IN_WORLD if "cube" in part.name else numpy.eye(4)
        number = [int(Path(f["image"]).stem.split("_")[1]) for f in frames]
        worlds = [numpy.loadtxt(folder / f"Camera_{n:03}.txt").reshape(4, 4) for n in number]
        return [metres(w @ cube) for w in worlds]
    if part.folder == "cube_cylinder":
        values = numpy.loadtxt(folder / "cube.0.pos").flatten()
        first = numpy.eye(4)
        first[:3, :3], first[:3, 3] = rotation(values[3:]), values[:3]
        return [metres(first) if f["image"].endswith("0000.png") else None for f in frames]
    return [None] * len(frames)


def row(name: str, frames: list[dict], errors: list[tuple[float, float]], right: int) -> str:
    def told(values: list[float]) -> str:
        if not values:
            return "|".join(["-", "-"])
        return f"{numpy.median(values):.2f} | {numpy.quantile(values, 0.9):.2f}"

    seconds = [sum(f["seconds"].values()) for f in frames]
    accepted = sum(f["found"] for f in frames)
    mm, degrees = told([e[0] for e in errors]), told([e[1] for e in errors])
    return (
        f"| {name} | {len(frames)} | {accepted} | {right if errors else '-'} | {mm} | {degrees} "
        f"| {numpy.median(seconds):.2f} | {max(seconds):.2f} |"
    )


# A pose is right within these, in millimetres and degrees.
RIGHT = (15.0, 8.0)


def is_right(e: tuple[float, float]) -> bool:
    return e[0] <= RIGHT[0] and e[1] <= RIGHT[1]


def set_rows(part: Sought, program: Program, model: Path, images: Path) -> list[str]:
    folder = images / part.folder
    rows, by_camera = [], {}
    for camera, (k, pattern) in part.cameras.items():
        frames = program.match(model, k, sorted(folder.glob(pattern)))
        known = [(f, t) for f, t in zip(frames, truths(part, folder, frames)) if t is not None]
        errors = [error(f, t, part.middle) for f, t in known if f["found"]]
        right = sum(map(is_right, errors))
        rows.append(row(f"{part.name} {camera}".strip(), frames, errors, right))
        by_camera[camera] = frames
        for f, t in known:
            off = error(f, t, part.middle)
            if not (f["found"] and is_right(off)):
                said = "found" if f["found"] else "not found"
                rows.append(f"<!-- {Path(f['image']).name}: {said}, {off[0]:.1f} mm, {off[1]:.1f}° -->")
    if part.folder == "teabox_stereo":
        extrinsic = numpy.loadtxt(folder / "cRightMcLeft.txt")
        extrinsic[3] = [0, 0, 0, 1]
        extrinsic = metres(extrinsic)
        name = {Path(f["image"]).stem.split("_")[1]: f for f in by_camera["left"]}
        pairs = [(name.get(Path(f["image"]).stem.split("_")[1]), f) for f in by_camera["right"]]
        both = [(a, b) for a, b in pairs if a and a["found"] and b["found"]]
        errors = [error(b, extrinsic @ pose(a), part.middle) for a, b in both]
        rows.append(row("teabox_stereo left against right", [b for _, b in pairs], errors, sum(map(is_right, errors))))
        for (a, b), off in zip(both, errors):
            rows.append(f"<!-- {Path(b['image']).name}: {off[0]:.1f} mm, {off[1]:.1f}° -->")
    return rows


Accepts = tuple[int, int, list[str]]


def tally(frames: list[dict]) -> Accepts:
    """How many are accepted, of how many, and which."""
    names = [f"{Path(f['image']).name} ({f['ratio']:.1f})" for f in frames if f["found"]]
    return len(names), len(frames), names


def false_accepts(part: Sought, program: Program, model: Path, images: Path) -> Accepts:
    all_frames: list[dict] = []
    for other in PARTS:
        # Of two parts in the same pictures the first is enough.
        first = next(p for p in PARTS if p.folder == other.folder)
        if other is not first or other.folder in [part.folder, *part.alike]:
            continue
        for k, pattern in other.cameras.values():
            all_frames += program.match(model, k, sorted((images / other.folder).glob(pattern)))
    return tally(all_frames)


def accepts_without(program: Program, model: Path, folder: Path) -> Accepts:
    """Of pictures by a camera that is not known: one with a usual angle of view is as good as any."""
    return tally(program.match(model, [700, 700, 319.5, 239.5], sorted(folder.iterdir())))


HEAD = (
    "| part | pictures | found | right | mm, median | 90 % | °, median | 90 % | s, median | most |\n"
    "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("premio")
    parser.add_argument("--only", default="", help="parts whose names hold this")
    parser.add_argument("--without", type=Path, help="a folder of pictures in which none of the parts is")
    parser.add_argument("options", nargs="*", help="what else `premio match` is told")
    arguments = parser.parse_args()
    images = os.environ.get("PREMIO_IMAGES")
    if not images:
        print("PREMIO_IMAGES is not set: pictures are passed over")
        return 0
    print("## Parts found in pictures of known solids\n")
    rows, accepts = [], []
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.premio, Path(folder), arguments.options)
        for part in PARTS:
            if arguments.only not in part.name:
                continue
            model = program.model(part)
            rows += set_rows(part, program, model, Path(images))
            found = [false_accepts(part, program, model, Path(images))]
            if arguments.without:
                found.append(accepts_without(program, model, arguments.without))
            for accepted, pictures, names in found:
                accepts.append(f"| {part.name} | {pictures} | {accepted} | {', '.join(names)} |")
    print("\n".join([HEAD, *rows]))
    print("\n| not in them: part | pictures | false accepts | which (ratio) |\n|---|--:|--:|---|")
    print("\n".join(accepts))
    return 0


if __name__ == "__main__":
    sys.exit(main())
