"""STL, OBJ, glTF and 3MF files read back by trimesh, and taken by Manifold as the boundary of a solid:
closed, oriented outwards, every side of two triangles, no triangle without an area, and of one volume
with the boundary but for the distance that triangles may be off.

OBJ is read here: trimesh makes other points of those that have several normals. A known failure is
listed with its reason.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import manifold3d
import numpy as np
import trimesh
from descriptions import descriptions, is_wrong, measures

SLIVER = "refused: edges closer than triangles can follow"
SINGLE = "refused: single precision"
KNOWN = {
    "cylinder-a-hundredth-millionth-into-a-ring.stl": SLIVER,
    "cylinder-a-hundredth-millionth-into-a-ring.obj": SLIVER,
    "cylinder-a-hundredth-millionth-into-a-ring.glb": SLIVER,
    "cylinder-a-hundredth-millionth-into-a-ring.3mf": SLIVER,
    "ball-by-a-plate-1e9-wide.stl": SINGLE,
    "ball-less-a-ring-that-touches-it-but-for-7e-9.stl": SLIVER,
    "ball-less-a-ring-that-touches-it-but-for-7e-9.obj": SLIVER,
    "ball-less-a-ring-that-touches-it-but-for-7e-9.glb": SLIVER,
    "ball-less-a-ring-that-touches-it-but-for-7e-9.3mf": SLIVER,
    "cone-around-a-ball-with-a-lip-of-1e-9.stl": SLIVER,
    "cone-around-a-ball-with-a-lip-of-1e-9.obj": SLIVER,
    "cone-around-a-ball-with-a-lip-of-1e-9.glb": SLIVER,
    "cone-around-a-ball-with-a-lip-of-1e-9.3mf": SLIVER,
    "bored-block-far-from-origin.stl": SINGLE,
    "cone-apex-1e-8-from-a-ring.glb": SINGLE,
    "cone-apex-6e-10-from-a-ring.glb": SINGLE,
    "cone-rim-a-billionth-into-a-ring.stl": SINGLE,
    "cones-whose-branches-pass-by-1e-9.glb": SINGLE,
    "coplanar-faces-tilted-by-1e-7.stl": SLIVER,
    "coplanar-faces-tilted-by-1e-7.obj": SLIVER,
    "coplanar-faces-tilted-by-1e-7.glb": SLIVER,
    "coplanar-faces-tilted-by-1e-7.3mf": SLIVER,
    "horn-ring-less-a-block-1e-8-above-its-pole.stl": SLIVER,
    "horn-ring-less-a-block-1e-8-above-its-pole.obj": SLIVER,
    "horn-ring-less-a-block-1e-8-above-its-pole.glb": SLIVER,
    "horn-ring-less-a-block-1e-8-above-its-pole.3mf": SLIVER,
}
# How far triangles are off, as a part of the size, where nothing is said.
DEVIATION = 1 / 2000
# How long the part's unit is in the file: glTF is in metres.
UNIT = {"stl": 1, "obj": 1, "glb": 1e-3, "3mf": 1}
# In these, what has one place is one point.
BY_PLACE = ("stl", "glb")


def obj(path):
    points, triangles = [], []
    for line in path.read_text().splitlines():
        what, *words = line.split()
        if what == "v":
            points.append([float(w) for w in words])
        elif what == "f":
            triangles.append([int(w.split("//")[0]) - 1 for w in words])
    return [(np.array(points), np.array(triangles))]


def meshes(path, form):
    """The points and the triangles of each mesh in a file."""
    if form == "obj":
        return obj(path)
    scene = trimesh.load_scene(path, process=False)
    found = []
    for node in scene.graph.nodes_geometry:
        place, name = scene.graph[node]
        mesh = scene.geometry[name]
        if not isinstance(mesh, trimesh.Trimesh):
            continue
        points, triangles = np.asarray(mesh.vertices), np.asarray(mesh.faces)
        if form in BY_PLACE:
            points, one = np.unique(points, axis=0, return_inverse=True)
            triangles = one.reshape(-1)[triangles]
        found.append((trimesh.transform_points(points, place), triangles))
    return found


def has_lines(path):
    shapes = trimesh.load_scene(path, process=False).geometry.values()
    return any(isinstance(shape, trimesh.path.Path3D) for shape in shapes)


def has_sharp_edges(premio, description):
    command = [premio, "export", description, "--format", "json"]
    told = subprocess.run(command, capture_output=True, text=True, check=True)
    return any(not arc["smooth"] for arc in json.loads(told.stdout)["arcs"])


def flaws(points, triangles, crowded):
    """What is wrong with a mesh; where it may be crowded, sides may have four triangles."""
    found = []
    sides = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    there, times = np.unique(sides[:, 0] * len(points) + sides[:, 1], return_counts=True)
    back, back_times = np.unique(sides[:, 1] * len(points) + sides[:, 0], return_counts=True)
    if not (np.array_equal(there, back) and np.array_equal(times, back_times)):
        found.append("not closed, or not oriented")
    if times.max() > 1 and not crowded:
        found.append("a side of more than two triangles")
    a, b, c = (points[triangles[:, i]] for i in range(3))
    if (np.linalg.norm(np.cross(b - a, c - a), axis=1) == 0).any():
        found.append("a triangle without an area")
    return found


def solid(points, triangles):
    """The volume that Manifold finds, and what it has to say against the mesh."""
    mesh = manifold3d.Mesh64(
        np.asarray(points, dtype=np.float64), np.asarray(triangles, dtype=np.uint64)
    )
    body = manifold3d.Manifold(mesh)
    error = body.status()
    return body.volume(), [] if error == manifold3d.Error.NoError else [str(error)]


def faults(premio, description, form, known, folder):
    path = Path(folder) / f"out.{form}"
    command = [premio, "export", description, "--format", form, "-o", str(path)]
    told = subprocess.run(command, capture_output=True, text=True)
    if told.returncode != 0:
        return [told.stderr.strip()]
    found, volume = [], 0.0
    crowded = form in BY_PLACE and known["non_manifold"]["edges"] > 0
    for points, triangles in meshes(path, form):
        # About its middle, so that where the part lies costs no digits.
        points = (points - points.mean(axis=0)) / UNIT[form]
        found += flaws(points, triangles, crowded)
        of_body, against = solid(points, triangles)
        found += against
        volume += of_body
    size = np.linalg.norm(np.subtract(known["bounds"]["max"], known["bounds"]["min"]))
    off = abs(volume - known["volume"])
    if off > known["area"] * size * DEVIATION:
        found.append(f"a volume off by {off / known['volume']:.2g}")
    if form == "3mf" and len(meshes(path, form)) != known["solids"]:
        found.append("not an object for each solid")
    if form == "glb" and has_lines(path) != has_sharp_edges(premio, description):
        found.append("lines that are no edges, or none of the edges")
    return found


def main():
    premio = sys.argv[1]
    read = wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, path in descriptions(folder):
            known = measures(premio, path)
            for form in UNIT if known else ():
                found = faults(premio, path, form, known, folder)
                read += 1
                wrong += is_wrong(f"{name}.{form}", found, KNOWN)
    print(f"{read} meshes read, {wrong} wrong, {len(KNOWN)} known to fail")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
