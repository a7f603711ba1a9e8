"""STEP files read back by OpenCASCADE: valid by its checker, of one volume with the boundary, of as
many solids, and of as many faces after its own merging.

A known failure is listed with its reason.
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

from descriptions import FOUND, descriptions, is_wrong, measures
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.Message import Message, Message_Gravity
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

# A face that an edge of four faces parts is one face once that edge is two.
PARTED = "faces that are parted where four meet are merged"
KNOWN = {
    "apple-cut-along-the-cone-of-its-pole": "refused: no seam from a pole inside the face",
    "ball-between-two-races": PARTED,
    "cylinder-in-a-hollow": PARTED,
    "cylinder-touching-block-along-line": PARTED,
    "plane-tangent-to-an-elliptic-cone": PARTED,
    "ring-under-a-block-turned-within-the-resolution": PARTED,
    "torus-lying-on-block": PARTED,
    "ball-in-a-tube-off-by-1e-6": "refused: the loops of a face 1e-6 apart",
    "bored-block-far-from-origin": "1e9 from the origin, the reader turns the solid inside out",
    "cone-apex-1e-8-from-a-ring": "refused: a face 1.6e-8 wide",
    "cone-around-a-ball-with-a-lip-of-1e-9": "refused: two edges of a face 1e-9 apart",
    "cone-rim-a-billionth-into-a-ring": "refused: an edge 1.6e-9 long",
    "cones-whose-branches-pass-by-1e-9": "refused: a face 7e-10 wide",
    "knob-off-by-4e-8": "refused: a face 2.9e-8 wide",
    "knob-off-by-3e-7-along-its-axis": "refused: a face 1.5e-8 wide",
    "coplanar-faces-tilted-by-1e-7": "refused: edges of a face 9e-11 apart",
    "cones-1e-9-apart": "slivers smaller than the reader's tolerance",
    "cone-resting-on-top-of-torus": "a seam through a face that touches itself in a point",
    "ellipsoids-nearly-similar": "refused: f64 does not determine a curve over a distant apex",
    "horn-ring-less-a-block-1e-8-above-its-pole": "refused: an edge 3.9e-17 long",
    "pipe-along-a-tube-off-by-1e-8": "refused: no seam passes between edges 1e-8 apart",
    "pipe-bend-along-a-floor": "refused: a wall without thickness along an arc",
}
# Volumes may differ by this part.
VOLUME = 1e-6


def count(shape, kind):
    explorer = TopExp_Explorer(shape, kind)
    number = 0
    while explorer.More():
        number += 1
        explorer.Next()
    return number


def quiet():
    """Restricts the reader's messages to failures."""
    for printer in Message.DefaultMessenger_s().Printers():
        printer.SetTraceLevel(Message_Gravity.Message_Fail)


def shape_in(path):
    reader = STEPControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_RetDone:
        return None
    reader.TransferRoots()
    return reader.OneShape()


def volumes(shape):
    """The volume by the reader's quadratures, each of which is inexact on some surfaces: adaptive ones
    of two accuracies, and a fixed one."""
    for accuracy in (1e-6, 1e-8):
        adaptive = GProp_GProps()
        BRepGProp.VolumeProperties_s(shape, adaptive, accuracy)
        yield adaptive.Mass()
    fixed = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, fixed)
    yield fixed.Mass()


def faults(premio, description, folder):
    """What is wrong with a description's STEP file; none where the program has none to write."""
    known = measures(premio, description)
    if known is None:
        return None
    out = Path(folder) / "out.step"
    command = [premio, "export", description, "--format", "step", "-o", str(out)]
    told = subprocess.run(command, capture_output=True, text=True)
    if told.returncode != 0:
        return [told.stderr.strip()]
    shape = shape_in(out)
    if shape is None:
        return ["not read"]
    found = []
    if not BRepCheck_Analyzer(shape).IsValid():
        found.append("not valid")
    # The slower quadratures are for volumes that the first one misses.
    off = math.inf
    for volume in volumes(shape):
        off = min(off, abs(volume / known["volume"] - 1))
        if off <= VOLUME:
            break
    if off > VOLUME:
        found.append(f"a volume off by {off:.2g}")
    sides = [("solids", count(shape, TopAbs_SOLID), known["solids"])]
    # What is found has faces that are too narrow for a file, or that a tolerance makes one.
    if Path(description).parent != FOUND:
        unifier = ShapeUpgrade_UnifySameDomain(shape)
        unifier.Build()
        sides.append(("faces", count(unifier.Shape(), TopAbs_FACE), known["faces"]))
    return found + [f"{n} {what}, not {m}" for what, n, m in sides if n != m]


def main():
    quiet()
    premio = sys.argv[1]
    read = left = wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, path in descriptions(folder):
            found = faults(premio, path, folder)
            if found is None:
                left += 1
                continue
            read += 1
            wrong += is_wrong(name, found, KNOWN)
    print(f"{read} read, {wrong} wrong, {len(KNOWN)} known to fail; {left} have nothing to write")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
