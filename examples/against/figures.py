"""Measures figures and their solids with Manifold: reads a `.csg` for `premio fuzz --profile figures --against`.

usage: figures.py FILE.csg

A `$fn` from 3 to 12 is a polygon, as premio reads it. Any other circle is a true one: the part is
made with N, 2 N and 4 N segments around, and Richardson's extrapolation gives the volume. What the
last step changes, multiplied by ten, is stated as the possible error.
"""

import json
import math
import re
import sys

import numpy as np
from manifold3d import CrossSection, Error, FillRule, JoinType, Manifold, OpType

# The segments around of the coarsest part.
SEGMENTS = 96

# The largest `$fn` that is a polygon.
LARGEST_POLYGON = 12

TOKEN = re.compile(r"\s*(?:([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)|([$A-Za-z_][\w]*)|(.))", re.S)


class Node:
    """A module with its arguments and operands."""

    def __init__(self, name, arguments, operands):
        self.name, self.arguments, self.operands = name, arguments, operands


class Parser:
    """A text as nodes."""

    def __init__(self, text):
        self.tokens = [match for match in TOKEN.findall(text) if any(match) and match[2] != "\n"]
        self.at = 0

    def peek(self):
        return "".join(self.tokens[self.at]) if self.at < len(self.tokens) else ""

    def take(self, expected=None):
        token = self.peek()
        if expected is not None and token != expected:
            raise ValueError(f"found {token!r}, expected {expected!r}")
        self.at += 1
        return token

    def value(self):
        token = self.take()
        if token == "[":
            values = []
            while self.peek() != "]":
                values.append(self.value())
                if self.peek() == ",":
                    self.take()
            self.take("]")
            return values
        return {"true": True, "false": False, "undef": None}.get(token) if token.isalpha() else float(token)

    def node(self):
        name, arguments = self.take(), {}
        self.take("(")
        while self.peek() != ")":
            if re.match(r"[$A-Za-z_]", self.peek()) and "".join(self.tokens[self.at + 1]) == "=":
                key = self.take()
                self.take("=")
            else:
                key = len(arguments)
            arguments[key] = self.value()
            if self.peek() == ",":
                self.take()
        self.take(")")
        operands = []
        if self.peek() == "{":
            self.take()
            while self.peek() != "}":
                operands.append(self.node())
            self.take("}")
        else:
            self.take(";")
        return Node(name, arguments, operands)

    def nodes(self):
        nodes = []
        while self.peek():
            nodes.append(self.node())
        return Node("union", {}, nodes)


class Builder:
    """The solid of nodes, with a number of segments around. What is empty is None."""

    def __init__(self, segments):
        self.segments, self.is_round = segments, False

    def count(self, arguments):
        sides = arguments.get("$fn") or 0
        if 3 <= sides <= LARGEST_POLYGON:
            return int(sides)
        self.is_round = True
        return self.segments

    def operands(self, node):
        return [self.build(operand) for operand in node.operands]

    def united(self, node):
        present = [part for part in self.operands(node) if part is not None]
        return type(present[0]).batch_boolean(present, OpType.Add) if present else None

    def build(self, node):
        part = getattr(self, node.name)(node, node.arguments)
        if isinstance(part, Manifold) and part.status() != Error.NoError:
            raise ValueError(str(part.status()))
        return None if part is None or part.is_empty() else part

    def union(self, node, _):
        return self.united(node)

    def difference(self, node, _):
        first, *others = self.operands(node)
        others = [part for part in others if part is not None]
        if first is None or not others:
            return first
        return type(first).batch_boolean([first, *others], OpType.Subtract)

    def intersection(self, node, _):
        parts = self.operands(node)
        if any(part is None for part in parts):
            return None
        return type(parts[0]).batch_boolean(parts, OpType.Intersect)

    def multmatrix(self, node, arguments):
        part, matrix = self.united(node), np.array(arguments[0], float)
        if isinstance(part, CrossSection):
            return part.transform(matrix[:2][:, [0, 1, 3]])
        return part and part.transform(matrix[:3])

    def cube(self, _, arguments):
        return Manifold.cube(arguments["size"])

    def cylinder(self, _, arguments):
        h, r1, r2 = (arguments[key] for key in ("h", "r1", "r2"))
        return Manifold.cylinder(h, r1, r2, self.count(arguments))

    def sphere(self, _, arguments):
        n, r = self.count(arguments), arguments["r"]
        angles = np.pi * (np.arange(n // 2) + 0.5) / (n // 2)
        arc = np.stack([r * np.sin(angles), -r * np.cos(angles)], axis=1)
        ends = [[0, arc[0, 1]], [0, arc[-1, 1]]]
        return Manifold.revolve(CrossSection([np.vstack([ends[0], arc, ends[1]])]), n)

    def square(self, _, arguments):
        return CrossSection.square(arguments["size"])

    def circle(self, _, arguments):
        n, r = self.count(arguments), arguments["r"]
        angles = 2 * np.pi * np.arange(n) / n
        return CrossSection([np.stack([r * np.cos(angles), r * np.sin(angles)], axis=1)])

    def polygon(self, _, arguments):
        return CrossSection([np.array(arguments["points"], float)], FillRule.EvenOdd)

    def offset(self, node, arguments):
        figure = self.united(node)
        if figure is None:
            return None
        if "r" in arguments:
            return figure.offset(arguments["r"], JoinType.Round, 2.0, self.count(arguments))
        join = JoinType.Square if arguments["chamfer"] else JoinType.Miter
        return figure.offset(arguments["delta"], join, 1e6, 0)

    def hull(self, node, _):
        parts = [part for part in self.operands(node) if part is not None]
        return type(parts[0]).batch_hull(parts) if parts else None

    def minkowski(self, node, _):
        """The sums of all corners. Manifold's own sum is wrong for some convex parts. As in OpenSCAD
        an empty operand adds nothing."""
        parts = [part for part in self.operands(node) if part is not None]
        if not parts:
            return None
        for part in parts:
            if abs(part.hull().volume() - part.volume()) > 1e-6 * part.volume():
                raise ValueError("a Minkowski sum of a part that is not convex")
        corners = [np.asarray(part.to_mesh().vert_properties, float)[:, :3] for part in parts]
        sums = corners[0]
        for more in corners[1:]:
            sums = (sums[:, None] + more[None]).reshape(-1, 3)
        return Manifold.hull_points(sums)

    def linear_extrude(self, node, arguments):
        figure, h = self.united(node), arguments["height"]
        if figure is None:
            return None
        part = Manifold.extrude(figure, h, 0, 0, arguments.get("scale", [1, 1]))
        return part.translate((0, 0, -h / 2)) if arguments["center"] else part

    def rotate_extrude(self, node, arguments):
        figure = self.united(node)
        if figure is None:
            return None
        part = Manifold.revolve(figure, self.count(arguments), arguments["angle"])
        # OpenSCAD's whole turn begins at the negative x axis.
        return part.rotate((0, 0, 180)) if arguments["angle"] == 360 else part


def volumes(tree):
    """The volumes with N, 2 N and 4 N segments; one if there are no circles."""
    found = []
    for segments in (SEGMENTS, 2 * SEGMENTS, 4 * SEGMENTS):
        builder = Builder(segments)
        part = builder.build(tree)
        found.append(0.0 if part is None else part.volume())
        if not builder.is_round:
            break
    return found


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        tree = Parser(file.read()).nodes()
    try:
        found = volumes(tree)
    except ValueError as error:
        print(json.dumps({"error": str(error)}))
        return
    if len(found) == 1:
        # The coordinates of a mesh are rounded.
        print(json.dumps({"volume": found[0], "tolerance": 1e-6}))
        return
    coarse, fine = (finer + (finer - coarser) / 3 for coarser, finer in zip(found, found[1:]))
    error = 10 * (abs(fine - coarse) + 1e-6 * abs(fine))
    print(json.dumps({"volume": fine, "volume_error": error}))


main()
