"""OpenSCAD beside premio: the command of `premio fuzz --against` with `--write-format csg`.

usage: openscad.py MODEL.csg [SEGMENTS]

Each part is made twice, with SEGMENTS and with twice as many segments around; what the second step
changes, doubled, is stated as the possible error. Needs `openscad`, and no package.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

EMPTY = "top level object is empty"
# Points are written with six digits.
TOLERANCE = 1e-4


def mesh(text, segments):
    """The corners and the faces that OpenSCAD makes of a description."""
    text = re.sub(r"\$fn = 0\b", f"$fn = {segments}", text)
    with tempfile.TemporaryDirectory() as folder:
        source, result = Path(folder) / "part.csg", Path(folder) / "part.off"
        source.write_text(text)
        command = ["openscad", "-o", str(result), str(source)]
        said = subprocess.run(command, capture_output=True, text=True)
        if EMPTY in said.stderr:
            return [], []
        if said.returncode != 0 or not result.exists():
            words = said.stderr.strip().splitlines()[-1:] or ["no words"]
            print(json.dumps({"error": words[0]}))
            sys.exit()
        words = iter(result.read_text().split())
    if next(words) != "OFF":
        sys.exit("expected a file of OFF")
    points, faces, _ = (int(next(words)) for _ in range(3))
    points = [[float(next(words)) for _ in range(3)] for _ in range(points)]
    return points, [[int(next(words)) for _ in range(int(next(words)))] for _ in range(faces)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def measures(points, faces):
    """The volume and the area by the divergence theorem, about a corner."""
    volume = area = 0.0
    for face in faces:
        first = points[face[0]]
        for k in range(1, len(face) - 1):
            a, b = ([p - q for p, q in zip(points[face[i]], first)] for i in (k, k + 1))
            across = cross(a, b)
            area += sum(x * x for x in across) ** 0.5 / 2
            volume += sum(x * (p - q) for x, p, q in zip(across, first, points[0])) / 6
    return volume, area


def main():
    text = Path(sys.argv[1]).read_text()
    segments = int(sys.argv[2]) if len(sys.argv) > 2 else 24
    volume, area = measures(*mesh(text, segments))
    finer_volume, finer_area = measures(*mesh(text, 2 * segments))
    print(json.dumps({
        "volume": finer_volume,
        "area": finer_area,
        "tolerance": TOLERANCE,
        "volume_error": 2 * abs(finer_volume - volume),
        "area_error": 2 * abs(finer_area - area),
    }))


if __name__ == "__main__":
    main()
