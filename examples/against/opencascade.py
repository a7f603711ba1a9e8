"""Open CASCADE beside premio: a template for `premio fuzz --against`.

Primitives and Boolean operations are those of BRepPrimAPI and BRepAlgoAPI, without a fuzzy value.
A result that the kernel's own checker rejects is stated as an error.
"""

import json
import sys
import time

from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_Transform,
)
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.collections import List_TopoDS_Shape
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer

# The relative accuracy of the integrals.
ACCURACY = 1e-8


def refuse(words):
    print(json.dumps({"error": words}))
    sys.exit()


def block(x, y, z):
    return BRepPrimAPI_MakeBox(x, y, z).Shape()


def wedge(x, y, z):
    corners = (gp_Pnt(0, 0, 0), gp_Pnt(x, 0, 0), gp_Pnt(0, 0, z))
    polygon = BRepBuilderAPI_MakePolygon(*corners, True)
    face = BRepBuilderAPI_MakeFace(polygon.Wire()).Face()
    return BRepPrimAPI_MakePrism(face, gp_Vec(0, y, 0)).Shape()


def cylinder(r, h):
    return BRepPrimAPI_MakeCylinder(r, h).Shape()


def cone(r, h):
    return BRepPrimAPI_MakeCone(r, 0, h).Shape()


def frustum(r1, r2, h):
    return cylinder(r1, h) if r1 == r2 else BRepPrimAPI_MakeCone(r1, r2, h).Shape()


def sphere(r):
    return BRepPrimAPI_MakeSphere(r).Shape()


def torus(major, minor):
    return BRepPrimAPI_MakeTorus(major, minor).Shape()


def moved(shape, matrix):
    motion = gp_Trsf()
    motion.SetValues(*(x for row in matrix for x in row))
    return BRepBuilderAPI_Transform(shape, motion, True).Shape()


def solids(shape):
    explorer = TopExp_Explorer(shape, TopAbs_SOLID)
    count = 0
    while explorer.More():
        count += 1
        explorer.Next()
    return count


def combined(operation, first, others):
    arguments, tools = List_TopoDS_Shape(), List_TopoDS_Shape()
    arguments.Append(first)
    for other in others:
        tools.Append(other)
    operation.SetArguments(arguments)
    operation.SetTools(tools)
    operation.Build()
    if not operation.IsDone():
        refuse("the Boolean operation fails")
    return operation.Shape()


def united(shapes):
    # What is empty is no argument.
    first, *others = [shape for shape in shapes if solids(shape)] or shapes[:1]
    return combined(BRepAlgoAPI_Fuse(), first, others) if others else first


def difference(shapes):
    first, *others = shapes
    others = [shape for shape in others if solids(shape)]
    return combined(BRepAlgoAPI_Cut(), first, others) if others and solids(first) else first


def intersection(shapes):
    result, *others = shapes
    for other in others:
        if not solids(result):
            return result
        if not solids(other):
            return other
        result = combined(BRepAlgoAPI_Common(), result, [other])
    return result


def measures(shape):
    if not BRepCheck_Analyzer(shape).IsValid():
        refuse("the result is not valid")
    volume, area = GProp_GProps(), GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, volume, ACCURACY)
    BRepGProp.SurfaceProperties_s(shape, area, ACCURACY)
    return {"volume": volume.Mass(), "area": area.Mass(), "solids": solids(shape)}


started = time.perf_counter()
try:
    # {{model}}
    result = measures(model)
except Exception as error:
    refuse(f"{type(error).__name__}: {error}")
print(json.dumps(result | {"seconds": time.perf_counter() - started}))
