"""STEP files projected by OpenCASCADE's exact hidden-line algorithm. Its visible lines must be as
long as the visible contours of the program, from three sides, for named cases and random trees.

Known differences are listed with their reasons; some occur on one machine and not on another. Two
kinds of parts are skipped: those with edges of four faces, which are two coincident edges in the
file, and those with smooth edges, which OpenCASCADE distinguishes by a rule of its own.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
from descriptions import descriptions, is_wrong, measures
from OCP.BRepGProp import BRepGProp
from OCP.BRepLib import BRepLib
from OCP.GProp import GProp_GProps
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
from OCP.Message import Message, Message_Gravity
from step import shape_in

# OpenCASCADE leaves pieces visible that ray casting on the tree finds hidden.
FALSE = "pieces behind a face are left visible; ray casting on the tree finds them hidden"
LOST = "an edge of a convex polyhedron is missing; the sum over its visible faces agrees with ours"
APEX = "a contour next to an apex is missing; with the apex 1e-4 away its length agrees with ours"
SHIFTED = "a limb is 1e-6 from an edge; with the ring 5e-4 away its length agrees with ours"
CLOSE = "edges closer to each other than its tolerance"
KNOWN = {
    "apex-and-edge-touching": FALSE,
    "balls-2e-7-apart": FALSE,
    "coaxial-tori-overlapping": FALSE,
    "cone-apex-6e-10-from-a-ring": APEX,
    "cone-apex-8e-9-inside-a-ball": FALSE,
    "cone-in-cylinder-rims-1e-7-apart": CLOSE,
    "cones-1e-9-apart": CLOSE,
    "cq-949b": FALSE,
    "cylinder-face-that-touches-itself": CLOSE,
    "elbow-about-its-own-side": FALSE,
    "example019.csg": FALSE,
    "loop-of-one-edge-through-an-apex": FALSE,
    "own-cone-in-cyl--1e-7": CLOSE,
    "ring-tilted-by-2e-13-in-a-wedge": SHIFTED,
    "sphere-tests.csg": LOST,
}
# Directions to the eye; z is up.
VIEWS = [(0.3, -0.8, 0.52), (0.71, 0.2, 0.67), (-0.5, 0.6, -0.62)]
# The allowed relative difference of lengths; the number of points taken of a piece.
LENGTH, POINTS = 2e-3, 400
# Random trees: profiles, and seeds of each.
PROFILES, SEEDS = "grid,tangent,near", 15


def unit(vector):
    return numpy.array(vector) / numpy.linalg.norm(vector)


def length_of(shape):
    if shape is None or shape.IsNull():
        return 0.0
    BRepLib.BuildCurves3d_s(shape)
    properties = GProp_GProps()
    BRepGProp.LinearProperties_s(shape, properties)
    return properties.Mass()


def theirs(shape, view):
    right = unit(numpy.cross((0, 0, 1), view))
    algorithm = HLRBRep_Algo()
    algorithm.Add(shape)
    axes = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(*unit(view)), gp_Dir(*right))
    algorithm.Projector(HLRAlgo_Projector(axes))
    algorithm.Update()
    algorithm.Hide()
    seen = HLRBRep_HLRToShape(algorithm)
    # Edges of a small angle are smooth ones to it.
    visible = [seen.VCompound(), seen.Rg1LineVCompound(), seen.OutLineVCompound()]
    return sum(length_of(lines) for lines in visible)


def ours(premio, description, view):
    eye = ",".join(repr(1000 * x) for x in view)
    command = [premio, "contours", description, "--ortho", f"--eye={eye}", "--target=0,0,0"]
    command += ["--format", "json", "--samples", str(POINTS)]
    told = subprocess.run(command, capture_output=True)
    if told.returncode != 0:
        return None
    told = json.loads(told.stdout)
    if any(contour["smooth"] for contour in told["contours"]):
        return None
    places = {junction["id"]: junction["point3"] for junction in told["junctions"]}
    along, total = unit(view), 0.0
    pieces = [piece for contour in told["contours"] for piece in contour["pieces"]]
    for piece in (piece for piece in pieces if piece["visible"]):
        points = [places.get(piece["start"]), *piece["samples"], places.get(piece["end"])]
        # A whole ring has no ends.
        closed = points[0] is None and points[-1] is None
        points = [point for point in points if point is not None]
        points = numpy.array(points + points[:1] if closed else points)
        flat = points - numpy.outer(points @ along, along)
        total += numpy.linalg.norm(numpy.diff(flat, axis=0), axis=1).sum()
    return total


def faults(premio, description, folder):
    """Views with lengths that differ; none where there is nothing to compare."""
    if measures(premio, description) is None:
        return None
    out = Path(folder) / "out.step"
    command = [premio, "export", description, "--format", "step", "-o", str(out)]
    told = subprocess.run(command, capture_output=True, text=True)
    if told.returncode != 0 or "more than two faces" in told.stderr:
        return None
    shape = shape_in(out)
    found = []
    for view in VIEWS:
        length = ours(premio, description, view)
        if length is None:
            return None
        other = theirs(shape, view)
        if abs(length - other) > LENGTH * max(length, other):
            found.append(f"from {view} {length:.6g} visible, not {other:.6g}")
    return found


def random_trees(premio, folder):
    command = [premio, "fuzz", "--profile", PROFILES, "--count", str(SEEDS), "--write", folder]
    subprocess.run(command, check=True, capture_output=True)
    for path in sorted(Path(folder).glob("*.padl")):
        yield path.stem, str(path)


def main():
    for printer in Message.DefaultMessenger_s().Printers():
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
    premio = sys.argv[1]
    compared = left = wrong = 0
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as trees:
        for name, path in [*descriptions(folder), *random_trees(premio, trees)]:
            found = faults(premio, path, folder)
            if found is None:
                left += 1
                continue
            compared += 1
            wrong += is_wrong(name, found, KNOWN)
    print(f"{compared} projected, {wrong} wrong, {len(KNOWN)} known to differ; {left} passed over")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
