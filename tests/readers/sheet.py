"""Sheets of four views read back by ezdxf. Its audit must find no error and make no repair. Every
stroke must be on a layer with its weight, and within the paper, and the part must be at true size.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf
from descriptions import CASES, measures
from ezdxf import bbox

# Refused: a view of surfaces that f64 does not separate, or of a part that no scale fits on paper.
REFUSED = 3
# The allowed error of polylines and of sampled bounding boxes, relative to the size.
SIZE = 1e-3


def faults(premio, description, known, folder):
    """The faults of a description's sheet; None if the program refuses its view."""
    path = Path(folder) / "sheet.dxf"
    command = [premio, "contours", description, "--views", "front,top,right,iso", "--hidden"]
    told = subprocess.run(
        [*command, "--smooth-edges", "--format", "dxf", "-o", str(path)],
        capture_output=True,
        text=True,
    )
    if told.returncode == REFUSED:
        return None
    if told.returncode != 0:
        return [told.stderr.strip()]
    document = ezdxf.readfile(path)
    audit = document.audit()
    found = [str(error) for error in (*audit.errors, *audit.fixes)]
    strokes = list(document.modelspace())
    found += [
        f"{stroke} on no layer" for stroke in strokes if stroke.dxf.layer not in document.layers
    ]
    drawn = [s for s in strokes if s.dxf.layer not in ("FRAME", "TITLE")]
    paper = bbox.extents(s for s in strokes if s.dxf.layer == "FRAME")
    box = bbox.extents(drawn, fast=False)
    if not (paper.inside(box.extmin) and paper.inside(box.extmax)):
        found.append("strokes outside the frame")
    # The view from above is placed below all others except the isometric one, which is next to it.
    sides = [hi - lo for lo, hi in zip(known["bounds"]["min"], known["bounds"]["max"], strict=True)]
    least = [sides[0] + sides[1], sides[1] + sides[2]]
    room = SIZE * sum(sides)
    if box.size.x < least[0] - room or box.size.y < least[1] - room:
        found.append(f"drawn {box.size.x} by {box.size.y}, of {sides}")
    return found


def main():
    premio = sys.argv[1]
    read = wrong = refused = 0
    with tempfile.TemporaryDirectory() as folder:
        for case in sorted(CASES.iterdir()):
            description = str(case / "model.padl")
            known = measures(premio, description)
            found = faults(premio, description, known, folder) if known else None
            if found is None:
                refused += 1
                continue
            read += 1
            if found:
                wrong += 1
                print(f"{case.name}: {'; '.join(found)}")
    print(f"{read} sheets read, {wrong} wrong; {refused} have no view")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
