"""Reads geometry files with VTK and writes what is in them as JSON, for the tests beside it.

usage: read_geometry.py OUT.json FILE...

Of each file, in order: {"time": s, "points": [[x, y, z], ...], "verts": [[i], ...], "lines": [[i, ...], ...], "polys": [[i, j, k], ...],
"arrays": {name: {"type": "float", "values": [[...], ...]}}}; of a .ply also "vertex" and "edge": {property: [value, ...]}; of a collection
(.pvd) the list of its [time, file]; of a .usda what read_usda.py tells.
Ends with 1 and what is wrong on standard error where VTK finds a fault.
"""

import json
import struct
import sys
import xml.etree.ElementTree

from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkIOGeometry import vtkOBJReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from read_usda import read_usda


def read_with(reader, file):
    faults = []
    for event in ("ErrorEvent", "WarningEvent"):
        reader.AddObserver(event, lambda *_: faults.append(f"{file}: {event}"))
    reader.SetFileName(file)
    reader.Update()
    if faults:
        sys.exit("\n".join(faults))
    return reader.GetOutput()


def cells(cell_array):
    cell_array.InitTraversal()
    points, all_cells = vtkIdList(), []
    while cell_array.GetNextCell(points):
        all_cells.append([points.GetId(i) for i in range(points.GetNumberOfIds())])
    return all_cells


def tuples(array):
    return [list(array.GetTuple(i)) for i in range(array.GetNumberOfTuples())]


def content(data):
    arrays = {}
    for i in range(data.GetPointData().GetNumberOfArrays()):
        array = data.GetPointData().GetArray(i)
        arrays[array.GetName()] = {"type": array.GetDataTypeAsString(), "values": tuples(array)}
    points = data.GetPoints()
    time = data.GetFieldData().GetArray("TimeValue")
    return {
        "time": time.GetTuple1(0) if time else None,
        "points": tuples(points.GetData()) if points else [],
        "verts": cells(data.GetVerts()),
        "lines": cells(data.GetLines()),
        "polys": cells(data.GetPolys()),
        "arrays": arrays,
    }


def ply(file):
    """What VTK reads: points, faces and normals; of the other properties of vertices, and of edges, it knows nothing."""
    result = content(read_with(vtkPLYReader(), file))
    with open(file, "rb") as whole:
        head, _, rest = whole.read().partition(b"end_header\n")
    head = [line.split() for line in head.decode().splitlines()]
    assert head[:2] == [["ply"], ["format", "binary_little_endian", "1.0"]], head[:2]
    result["time"] = next(float(line[2]) for line in head if line[:2] == ["comment", "time"])
    elements = []
    for line in head[2:]:
        if line[0] == "element":
            elements.append((line[1], int(line[2]), []))
        elif line[0] == "property":
            elements[-1][2].append(line[1:])
        else:
            assert line[0] == "comment", line
    for name, count, properties in elements:
        if name == "face":
            assert properties == [["list", "uchar", "int", "vertex_indices"]], properties
            rows = list(struct.iter_unpack("<Biii", rest[: 13 * count]))
            assert [list(row[1:]) for row in rows] == result["polys"] and all(row[0] == 3 for row in rows), "faces"
            rest = rest[13 * count :]
            continue
        row = struct.Struct("<" + "".join({"float": "f", "uint": "I", "int": "i"}[kind] for kind, _ in properties))
        rows = list(row.iter_unpack(rest[: row.size * count]))
        rest = rest[row.size * count :]
        result[name] = {p[1]: [r[k] for r in rows] for k, p in enumerate(properties)}
    assert not rest, f"{len(rest)} bytes too many"
    return result


def collection(file):
    root = xml.etree.ElementTree.parse(file).getroot()
    assert root.tag == "VTKFile" and root.get("type") == "Collection", file
    return [[float(d.get("timestep")), d.get("file")] for d in root.findall("Collection/DataSet")]


def read(file):
    if file.endswith(".vtp"):
        return content(read_with(vtkXMLPolyDataReader(), file))
    if file.endswith(".obj"):
        return content(read_with(vtkOBJReader(), file))
    if file.endswith(".ply"):
        return ply(file)
    if file.endswith(".usda"):
        with open(file) as text:
            return read_usda(text.read())
    if file.endswith(".pvd"):
        return collection(file)
    sys.exit(f"{file}: of no format that this can read")


if __name__ == "__main__":
    result = [read(file) for file in sys.argv[2:]]
    with open(sys.argv[1], "w") as out:
        json.dump(result, out)
