"""Parts found in pictures of known solids that are changed: noisier, blurred, brighter, compressed, of
another size, turned, cut.

PREMIO_IMAGES names the folder of the pictures, as for find.py. The pose of a picture that is changed is
known from that of the picture as it is: of castle_simu it is exact, of others what is found there counts,
and of the right tea box what is found in the left one.
"""

import argparse
import io
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy
from find import PARTS, Matrix, Program, Sought, error, is_right, metres, pose, truths
from PIL import Image, ImageFilter

Intrinsics = list[float]
# A picture by a camera, and how the camera is turned.
Changed = tuple[Image.Image, Intrinsics, Matrix]
Change = Callable[[Image.Image, Intrinsics], Changed]
STAYS = numpy.eye(4)


def levels(of: Callable[[numpy.ndarray], numpy.ndarray]) -> Change:
    def change(image: Image.Image, k: Intrinsics) -> Changed:
        values = numpy.clip(numpy.rint(of(numpy.asarray(image, float))), 0, 255)
        return Image.fromarray(values.astype(numpy.uint8)), k, STAYS

    return change


def noise(deviation: float) -> Change:
    random = numpy.random.default_rng(5)
    return levels(lambda v: v + random.normal(0, deviation, v.shape))


def blur(deviation: float) -> Change:
    return lambda image, k: (image.filter(ImageFilter.GaussianBlur(deviation)), k, STAYS)


def compressed(quality: int) -> Change:
    def change(image: Image.Image, k: Intrinsics) -> Changed:
        file = io.BytesIO()
        image.save(file, "JPEG", quality=quality)
        return Image.open(file).convert("L"), k, STAYS

    return change


def scaled(by: float) -> Change:
    def change(image: Image.Image, k: Intrinsics) -> Changed:
        size = [round(by * side) for side in image.size]
        x, y = [new / old for new, old in zip(size, image.size)]
        k = [k[0] * x, k[1] * y, (k[2] + 0.5) * x - 0.5, (k[3] + 0.5) * y - 0.5]
        return image.resize(size, Image.Resampling.LANCZOS), k, STAYS

    return change


def turned(image: Image.Image, k: Intrinsics) -> Changed:
    turn = numpy.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    k = [k[1], k[0], image.size[1] - 1 - k[3], k[2]]
    return image.transpose(Image.Transpose.ROTATE_270), k, turn


def cut(left: int, top: int, right: int, bottom: int) -> Change:
    def change(image: Image.Image, k: Intrinsics) -> Changed:
        box = (left, top, image.size[0] - right, image.size[1] - bottom)
        return image.crop(box), [k[0], k[1], k[2] - left, k[3] - top], STAYS

    return change


CHANGES: dict[str, Change] = {
    "as it is": lambda image, k: (image, k, STAYS),
    "noise of 4 levels": noise(4),
    "noise of 10 levels": noise(10),
    "blurred by 1 pixel": blur(1),
    "levels to the power of 0.6": levels(lambda v: 255 * (v / 255) ** 0.6),
    "JPEG of quality 40": compressed(40),
    "0.6 times as large": scaled(0.6),
    "1.5 times as large": scaled(1.5),
    "turned by 90°": turned,
    "cut by 20 to 40 pixels": cut(40, 20, 20, 10),
}


def matched(
    program: Program, model: Path, pictures: list[Path], k: Intrinsics, change: Change
) -> tuple[list[dict], Matrix]:
    """The reports of changed pictures, and how their camera is turned."""
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for picture in pictures:
            image, seen_by, turn = change(Image.open(picture).convert("L"), k)
            paths.append(Path(folder) / f"{picture.stem}.png")
            image.save(paths[-1])
        return program.match(model, seen_by, paths), turn


def known(part: Sought, folder: Path, camera: str, frames: list[dict], known_by: dict) -> None:
    """Notes the poses of pictures as they are."""
    extrinsic = None
    if part.folder == "teabox_stereo":
        values = numpy.loadtxt(folder / "cRightMcLeft.txt")
        values[3] = [0, 0, 0, 1]
        extrinsic = metres(values)
    for frame, truth in zip(frames, truths(part, folder, frames)):
        stem = Path(frame["image"]).stem
        if truth is None and frame["found"] and camera != "right":
            truth = pose(frame)
        if truth is not None and (camera, stem) not in known_by:
            known_by[camera, stem] = truth
            if extrinsic is not None:
                known_by["right", stem.replace("left", "right")] = extrinsic @ truth


def rows(part: Sought, program: Program, images: Path) -> list[str]:
    model, folder = program.model(part), images / part.folder
    known_by: dict[tuple[str, str], Matrix] = {}
    out = []
    for name, change in CHANGES.items():
        for camera, (k, pattern) in part.cameras.items():
            frames, turn = matched(program, model, sorted(folder.glob(pattern)), k, change)
            if name == "as it is":
                known(part, folder, camera, frames, known_by)
            truth = {stem: turn @ t for (c, stem), t in known_by.items() if c == camera}
            found = [f for f in frames if f["found"]]
            judged = [f for f in found if Path(f["image"]).stem in truth]
            right = [is_right(error(f, truth[Path(f["image"]).stem], part.middle)) for f in judged]
            out.append(
                f"| {part.name} {camera}".strip()
                + f" | {name} | {len(frames)} | {len(found)} | {sum(right)} | {len(right) - sum(right)} |"
            )
    return out


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("premio")
    parser.add_argument("--only", default="", help="parts whose names hold this")
    arguments = parser.parse_args()
    images = os.environ.get("PREMIO_IMAGES")
    if not images:
        print("PREMIO_IMAGES is not set: pictures are passed over")
        return 0
    print("## Parts found in changed pictures of known solids\n")
    print("| part | pictures are | pictures | found | right | wrong |\n|---|---|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.premio, Path(folder), [])
        for part in PARTS:
            if arguments.only in part.name:
                print("\n".join(rows(part, program, Path(images))), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
