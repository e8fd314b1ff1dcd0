"""Reads geometry files with VTK and writes what is in them as JSON, for the tests beside it.

usage: read_geometry.py OUT.json FILE...

Of each file, in order: {"time": s, "points": [[x, y, z], ...], "verts": [[i], ...], "lines": [[i, ...], ...], "polys": [[i, j, k], ...],
"arrays": {name: {"type": "float", "values": [[...], ...]}}}; of a collection (.pvd) the list of its [time, file].
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
        return content(read_with(vtkPLYReader(), file))
    if file.endswith(".pvd"):
        return collection(file)
    sys.exit(f"{file}: of no format that this can read")


if __name__ == "__main__":
    result = [read(file) for file in sys.argv[2:]]
    with open(sys.argv[1], "w") as out:
        json.dump(result, out)
