"""The colours of faces in STEP, glTF and 3MF files, as other programs read them.

usage: colours.py PREMIO
"""
import pathlib
import subprocess
import sys
import tempfile

import lib3mf
import numpy
import trimesh
from OCP.collections import Sequence_TDF_Label
from OCP.IFSelect import IFSelect_RetDone
from OCP.Quantity import Quantity_ColorRGBA, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

# A red block with a bore in half-transparent blue, an orange ball that is stretched under its colour, and
# a bar without a colour. The outermost colour counts.
TEXT = """
difference() {
  color([1, 0, 0, 1]) { cube(size = [10, 10, 10]); }
  color([0, 0, 1, 0.5]) { multmatrix([[1, 0, 0, 5], [0, 1, 0, 5], [0, 0, 1, -1], [0, 0, 0, 1]]) {
    cylinder(h = 12, r1 = 2, r2 = 2); } }
}
multmatrix([[2, 0, 0, 30], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {
  color([1, 0.5, 0, 1]) { color([0, 1, 0, 1]) { sphere(r = 3); } }
}
multmatrix([[1, 0, 0, 50], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(size = [4, 5, 6]); }
"""
# Faces of each colour.
FACES = {(255, 0, 0, 255): 6, (0, 0, 255, 128): 1, (255, 128, 0, 255): 1, None: 6}


def of_step(path):
    """The number of faces of each colour in a STEP file."""
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    reader = STEPCAFControl_Reader()
    reader.SetColorMode(True)
    assert reader.ReadFile(str(path)) == IFSelect_RetDone
    assert reader.Transfer(document)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    labels = Sequence_TDF_Label()
    shapes.GetFreeShapes(labels)
    count = {}
    for k in range(1, labels.Length() + 1):
        faces = TopExp_Explorer(shapes.GetShape_s(labels.Value(k)), TopAbs_FACE)
        while faces.More():
            colour = Quantity_ColorRGBA()
            known = colours.GetColor(faces.Current(), XCAFDoc_ColorSurf, colour)
            key = None
            if known:
                rgb = colour.GetRGB().Values(Quantity_TOC_sRGB)
                key = tuple(int(round(255 * x)) for x in [*rgb, colour.Alpha()])
            count[key] = count.get(key, 0) + 1
            faces.Next()
    return count


def near(mesh):
    """The colour that triangles should have, by the place of their middles."""
    x, y, _ = numpy.mean(mesh, axis=1).T
    bore = numpy.hypot(x - 5, y - 5) < 2.001
    # The ends of the block are outside of the bore.
    names = numpy.where(x > 45, "none", numpy.where(x > 15, "orange", numpy.where(bore, "blue", "red")))
    return set(names)


def of_glb(path):
    """The places of the triangles of each colour in a glTF file, in linear light."""
    scene = trimesh.load(path)
    found = {}
    for geometry in scene.geometry.values():
        if not isinstance(geometry, trimesh.Trimesh):
            continue
        material = geometry.visual.material
        matrix = scene.graph[scene.graph.nodes_geometry[0]][0]
        points = trimesh.transform_points(geometry.vertices, matrix)
        # Metres and y up, to millimetres and z up.
        points = 1000 * numpy.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
        found.setdefault(material.name, set()).update(near(points[geometry.faces]))
    return found


def of_threemf(path):
    """The places of the triangles of each colour in a 3MF file, which a strict reader accepts."""
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert reader.GetWarningCount() == 0
    groups = model.GetBaseMaterialGroups()
    names = {}
    while groups.MoveNext():
        group = groups.GetCurrentBaseMaterialGroup()
        names.update({i: group.GetName(i) for i in group.GetAllPropertyIDs()})
    found = {}
    objects = model.GetMeshObjects()
    while objects.MoveNext():
        mesh = objects.GetCurrentMeshObject()
        points = numpy.array([p.Coordinates[:] for p in mesh.GetVertices()])
        corners = numpy.array([t.Indices[:] for t in mesh.GetTriangleIndices()])
        for k, triangle in enumerate(corners):
            name = names[mesh.GetTriangleProperties(k).PropertyIDs[0]]
            found.setdefault(name, set()).update(near(points[triangle][None]))
    return found


def main():
    premio = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        part = folder / "colours.csg"
        part.write_text(TEXT)
        files = {}
        for ending in ["step", "glb", "3mf"]:
            files[ending] = folder / f"colours.{ending}"
            subprocess.run([premio, "export", part, "-o", files[ending]], check=True, capture_output=True)
        faces = of_step(files["step"])
        assert faces == FACES, faces
        colours = {"#FF0000FF": {"red"}, "#0000FF80": {"blue"}, "#FF8000FF": {"orange"}}
        found = of_glb(files["glb"])
        assert found == {**colours, "faces": {"none"}}, found
        found = of_threemf(files["3mf"])
        assert found == {**colours, "none": {"none"}}, found
    print("colours: right in STEP, glTF and 3MF")


main()
