"""Manifold beside premio: a template for `premio fuzz --against`.

Manifold has triangles only. Each part is made twice, with N and with 2 N segments around; what the
second step changes, doubled, is stated as the possible error.
"""

import json
import sys
import time

import numpy as np
from manifold3d import Error, Manifold, Mesh64, OpType

# The segments around of the coarser part.
SEGMENTS = 96
segments = SEGMENTS


def solid(points, triangles):
    points, triangles = np.asarray(points, np.float64), np.asarray(triangles, np.uint64)
    return Manifold(Mesh64(np.ascontiguousarray(points), np.ascontiguousarray(triangles)))


def block(x, y, z):
    return Manifold.cube((x, y, z))


def wedge(x, y, z):
    points = [[a, b, c] for b in (0, y) for a, c in ((0, 0), (x, 0), (0, z))]
    return solid(
        points, [[0, 1, 2], [3, 5, 4], [0, 3, 1], [1, 3, 4], [1, 4, 2], [2, 4, 5], [2, 5, 0], [0, 5, 3]]
    )


def revolved(profile, is_ring):
    """A profile of radii and heights, turned about z. A ring's is closed, and counterclockwise;
    another begins below on the axis and ends above on it."""
    n, m = segments, len(profile)
    angles = 2 * np.pi * np.arange(n) / n
    radii, heights = np.asarray(profile, np.float64).T
    points = np.empty((n, m, 3))
    points[..., 0] = np.cos(angles)[:, None] * radii
    points[..., 1] = np.sin(angles)[:, None] * radii
    points[..., 2] = heights
    here = np.arange(n)[:, None] * m + np.arange(m)
    if not is_ring:
        # All points on the axis are those of the first angle.
        here[:, radii == 0] = here[0, radii == 0]
    beside = np.roll(here, -1, axis=0)
    last = m if is_ring else m - 1
    above, beside_above = (np.roll(k, -1, axis=1)[:, :last] for k in (here, beside))
    here, beside = here[:, :last], beside[:, :last]
    corners = [here, beside, beside_above, here, beside_above, above]
    triangles = np.stack(corners, axis=-1).reshape(-1, 3)
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    used, triangles = np.unique(triangles, return_inverse=True)
    return solid(points.reshape(-1, 3)[used], triangles.reshape(-1, 3))


def frustum(r1, r2, h):
    profile = [(0, 0), (r1, 0), (r2, h), (0, h)]
    return revolved([p for k, p in enumerate(profile) if k == 0 or p != profile[k - 1]], False)


def cylinder(r, h):
    return revolved([(0, 0), (r, 0), (r, h), (0, h)], False)


def cone(r, h):
    return revolved([(0, 0), (r, 0), (0, h)], False)


def sphere(r):
    steps = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)
    profile = np.stack([r * np.cos(steps), r * np.sin(steps)], axis=1)
    profile[[0, -1], 0] = 0
    return revolved(profile, False)


def torus(major, minor):
    angles = 2 * np.pi * np.arange(segments) / segments
    return revolved(np.stack([major + minor * np.cos(angles), minor * np.sin(angles)], axis=1), True)


def moved(part, matrix):
    return part.transform(np.asarray(matrix, np.float64))


def united(parts):
    return Manifold.batch_boolean(parts, OpType.Add)


def difference(parts):
    return Manifold.batch_boolean(parts, OpType.Subtract)


def intersection(parts):
    return Manifold.batch_boolean(parts, OpType.Intersect)


def part():
    # {{model}}
    return model


def measures():
    result = part()
    if result.status() != Error.NoError:
        print(json.dumps({"error": str(result.status())}))
        sys.exit()
    return result.volume(), result.surface_area()


started = time.perf_counter()
volume, area = measures()
segments = 2 * SEGMENTS
finer_volume, finer_area = measures()
print(json.dumps({
    "volume": finer_volume,
    "area": finer_area,
    "volume_error": 2 * abs(finer_volume - volume),
    "area_error": 2 * abs(finer_area - area),
    "seconds": time.perf_counter() - started,
}))
