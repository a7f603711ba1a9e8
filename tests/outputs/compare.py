"""Compares the outputs of two builds of the program bit for bit: for changes that must not change behaviour.

    tests/outputs/compare.py record PREMIO DIGESTS    runs every command and writes one digest a line
    tests/outputs/compare.py against PREMIO DIGESTS   runs every command and reports each difference

The inputs are the named cases, and of the folders that PREMIO_CORPUS and PREMIO_IMAGES name the
descriptions and the pictures. A digest covers the exit status, standard output and every file written.
Messages on standard error are left out.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT / "tests" / "cases"
SETUP = """material = "plastic"
[camera]
eye = {eye}
target = {target}
[[light]]
position = {light}
[sensor]
focal = 16
film = [8.8, 6.6]
resolution = [320, 240]
electrons = 10000
[detector]
mask = "sobel"
threshold = 10
"""
SPHERES = """material = "plastic"
[viewing]
count = 6
[illumination]
count = 3
[sensor]
focal = 16
film = [8.8, 6.6]
resolution = [320, 240]
[detector]
mask = "sobel"
threshold = 10
"""
# Every n-th description is predicted, summed up in a model, and planned for.
PREDICTED, MODELLED = 4, 24
# Pictures to match with: the folder, the camera's matrix, and the size of the block sought.
PICTURES = [
    ("castle_simu", [700, 700, 320, 240], [100, 100, 100], [-50, -50, -50]),
    ("cube_cylinder", [547.7367575, 542.0744058, 338.7036994, 234.5083345], [75.4, 75.4, 75.4], [0, 0, 0]),
    ("teabox_stereo", [680.0610, 680.8200, 338.1239, 247.1569], [165, 68, 80], [0, 0, 0]),
]
LIMIT_SECONDS = 300


@dataclass
class Run:
    """A command with its inputs, and the suffix of the file that it writes, if it writes one."""

    name: str
    arguments: list[str]
    output: str | None = None
    # Whether wrong arguments are a fault of this script.
    must_be_read: bool = False


def descriptions(folder: Path):
    """Every description with a name."""
    for case in sorted(CASES.iterdir()):
        yield case.name, case / "model.padl"
    corpus = os.environ.get("PREMIO_CORPUS")
    if not corpus:
        print("PREMIO_CORPUS is not set: only the named cases are compared", file=sys.stderr)
        return
    for path in sorted(Path(corpus).glob("openscad/*.csg")):
        yield path.name, path
    for path in sorted(Path(corpus).glob("scad/**/*.csg")):
        yield str(path.relative_to(corpus)), path
    for path in sorted(Path(corpus).glob("faults/**/*.padl")):
        yield str(path.relative_to(corpus)), path
    for case in json.loads((Path(corpus) / "cases.json").read_text()):
        # Relative to the working folder of all runs, because some outputs contain the path.
        path = Path(f"{case['id']}.json")
        (folder / path).write_text(json.dumps(case["tree"]))
        yield case["id"], path


def runs_of(name: str, path: Path, folder: Path):
    """What is done with a description."""
    file = str(path)
    yield Run(f"{name}: info", ["info", file, "--json"])
    yield Run(f"{name}: contours", ["contours", file, "--view", "iso", "--hidden", "--format", "json"])
    yield Run(f"{name}: svg", ["contours", file, "--eye", "131,-217,159", "--hidden", "--smooth-edges", "--format", "svg"])
    for suffix in ("svg", "dxf"):
        views = ["--views", "front,top,right", "--hidden", "--format", suffix]
        yield Run(f"{name}: sheet {suffix}", ["contours", file, *views])
    for suffix in ("step", "stl", "obj", "glb", "3mf", "json"):
        yield Run(f"{name}: export {suffix}", ["export", file], suffix)
    for suffix in ("padl", "json", "csg"):
        yield Run(f"{name}: convert {suffix}", ["convert", file], suffix)


def setup_of(premio: str, path: Path, folder: Path) -> str | None:
    """A setup before a part, by its bounds; none of a part without a solid."""
    done = subprocess.run([premio, "info", str(path), "--json"], capture_output=True, cwd=folder)
    bounds = json.loads(done.stdout).get("bounds") if done.returncode == 0 else None
    if not bounds or bounds["min"] == bounds["max"]:
        return None
    low, high = bounds["min"], bounds["max"]
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    size = sum((b - a) ** 2 for a, b in zip(low, high)) ** 0.5
    at = lambda direction: [c + size * d for c, d in zip(centre, direction)]
    return SETUP.format(eye=at((1.1, -1.5, 1.0)), target=centre, light=at((0.7, -0.9, 2.6)))


def predictions_of(premio: str, name: str, path: Path, folder: Path, number: int):
    """What is predicted of a description."""
    text = setup_of(premio, path, folder)
    if text is None:
        return
    file, setup, spheres = str(path), f"setup-{number}.toml", "spheres.toml"
    (folder / setup).write_text(text)
    commands = {
        "predict": (["predict", file, "--setup", setup], "json"),
        "overlay": (["predict", file, "--setup", setup, "-o", os.devnull, "--overlay"], "svg"),
        "render": (["render", file, "--setup", setup], "png"),
    }
    if number % MODELLED == 0:
        commands["model"] = (["model", file, "--setups", spheres], "model")
        commands["advise"] = (["advise", file, "--setups", spheres, "--goal", "pose", "--json"], None)
    for command, (arguments, output) in commands.items():
        yield Run(f"{name}: {command}", arguments, output, must_be_read=True)


def matches(folder: Path):
    """Parts looked for in pictures."""
    images = os.environ.get("PREMIO_IMAGES")
    if not images:
        print("PREMIO_IMAGES is not set: no pictures are matched", file=sys.stderr)
        return
    for set_name, (fx, fy, cx, cy), size, corner in PICTURES:
        tree = {"prim": "block", "size": size, "transform": [{"translate": corner}]}
        part, camera = Path(f"{set_name}.json"), Path(f"{set_name}.camera.json")
        (folder / part).write_text(json.dumps(tree))
        matrix = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]
        (folder / camera).write_text(json.dumps({"K": matrix, "width": 640, "height": 480}))
        pictures = sorted(Path(images).glob(f"{set_name}/**/*.png"))[:4]
        for picture in pictures:
            arguments = ["match", str(part), str(picture), "--camera", str(camera)]
            yield Run(f"{set_name}: {picture.name}", arguments, must_be_read=True)
        arguments = ["track", str(part), *map(str, pictures), "--camera", str(camera)]
        yield Run(f"{set_name}: track", arguments, must_be_read=True)


def all_runs(premio: str, folder: Path):
    (folder / "spheres.toml").write_text(SPHERES)
    for number, (name, path) in enumerate(descriptions(folder)):
        yield from runs_of(name, path, folder)
        if number % PREDICTED == 0:
            yield from predictions_of(premio, name, path, folder, number)
    yield from matches(folder)


def digest(premio: str, run: Run, folder: Path) -> str:
    """The digest of all that a run gives; the time that a match took is not part of it."""
    sha = hashlib.sha256()
    arguments = list(run.arguments)
    with tempfile.TemporaryDirectory(dir=folder) as place:
        if run.output:
            # Some formats contain their file's name.
            option = [] if arguments[-1] == "--overlay" else ["-o"]
            arguments += [*option, str(Path(place) / f"out.{run.output}")]
        try:
            done = subprocess.run([premio, *arguments], capture_output=True, timeout=LIMIT_SECONDS, cwd=folder)
            if run.must_be_read and done.returncode == 2:
                sys.exit(f"{run.name}: {done.stderr.decode()}")
            sha.update(str(done.returncode).encode() + without_times(done.stdout))
        except subprocess.TimeoutExpired:
            sha.update(b"given up")
        for file in sorted(path for path in Path(place).rglob("*") if path.is_file()):
            sha.update(file.suffix.encode() + file.read_bytes())
    return sha.hexdigest()


def without_times(text: bytes) -> bytes:
    """JSON without the members that measure time."""
    if b'"seconds"' not in text:
        return text
    def plain(value):
        if isinstance(value, dict):
            return {key: plain(v) for key, v in value.items() if key != "seconds"}
        return [plain(v) for v in value] if isinstance(value, list) else value
    lines = text.decode().splitlines()
    try:
        return json.dumps(plain(json.loads(text))).encode()
    except json.JSONDecodeError:
        return json.dumps([plain(json.loads(line)) for line in lines if line]).encode()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["record", "against"])
    parser.add_argument("premio")
    parser.add_argument("digests", type=Path)
    parser.add_argument("--only", default="", help="runs whose name contains this")
    options = parser.parse_args()
    premio = str(Path(options.premio).resolve())
    with tempfile.TemporaryDirectory() as folder:
        runs = [run for run in all_runs(premio, Path(folder)) if options.only in run.name]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            digests = list(pool.map(lambda run: digest(premio, run, Path(folder)), runs))
    found = {run.name: value for run, value in zip(runs, digests)}
    if options.task == "record":
        options.digests.write_text("".join(f"{value} {name}\n" for name, value in found.items()))
        print(f"{len(found)} runs recorded")
        return
    lines = options.digests.read_text().splitlines()
    known = {name: value for value, name in (line.split(" ", 1) for line in lines)}
    wanted = {name: value for name, value in known.items() if options.only in name}
    different = [name for name in wanted if found.get(name) != wanted[name]]
    different += [name for name in found if name not in wanted]
    for name in different:
        print(f"differs: {name}")
    print(f"{len(wanted)} runs compared, {len(different)} differ")
    sys.exit(1 if different else 0)


if __name__ == "__main__":
    main()
