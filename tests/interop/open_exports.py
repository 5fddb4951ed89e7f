"""Opens exported files with VTK, the library that ParaView reads with, and with NumPy.

usage: open_exports.py FILE...  -> one JSON line that says what was found in each file
"""

import json
import os
import sys

import numpy as np
import vtk

READERS = {
    ".vtu": vtk.vtkXMLUnstructuredGridReader,
    ".vti": vtk.vtkXMLImageDataReader,
    ".vtr": vtk.vtkXMLRectilinearGridReader,
}


def vtk_file(path, suffix):
    reader = READERS[suffix]()
    if not reader.CanReadFile(path):
        raise SystemExit(f"{path}: VTK cannot read it")
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    arrays = {}
    for kind, fields in (("point", data.GetPointData()), ("cell", data.GetCellData())):
        for i in range(fields.GetNumberOfArrays()):
            array = fields.GetArray(i)
            arrays[array.GetName()] = {
                "on": kind,
                "tuples": array.GetNumberOfTuples(),
                "components": array.GetNumberOfComponents(),
                "range": list(array.GetRange(-1)),
                "unit": array.GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL()),
            }
    n = data.GetNumberOfPoints()
    first = data.GetPointData().GetArray(0)
    time = data.GetFieldData().GetArray("TimeValue")
    return {
        "points": n,
        "bounds": list(data.GetBounds()),
        "arrays": arrays,
        "time_s": time.GetValue(0) if time else None,
        # Place and first array of each point, where there are few.
        "nodes": [[*data.GetPoint(i), first.GetTuple(i)[0]] for i in range(n)] if n <= 100 else None,
    }


def numpy_file(path):
    with np.load(path) as data:
        return {"arrays": {name: {"shape": list(data[name].shape)} for name in data.files}}


def main(paths):
    found = {}
    for path in paths:
        suffix = os.path.splitext(path)[1]
        found[os.path.basename(path)] = numpy_file(path) if suffix == ".npz" else vtk_file(path, suffix)
    print(json.dumps(found))


if __name__ == "__main__":
    main(sys.argv[1:])
