import sys

from answer import answer, area, counts, import_or_say

vtk = import_or_say("vtk")
import numpy
from vtk.util.numpy_support import vtk_to_numpy

READERS = {"vtu": "vtkXMLUnstructuredGridReader", "pvtu": "vtkXMLPUnstructuredGridReader", "h5": "vtkHDFReader"}
reader = getattr(vtk, READERS[sys.argv[1].split(".")[-1]])()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
points = vtk_to_numpy(grid.GetPoints().GetData())
types = vtk_to_numpy(grid.GetCellTypesArray())
ghosts = grid.GetCellGhostArray()  # cells that another piece counts, of pieces with ghost triangles
counted = numpy.ones(len(types), bool) if ghosts is None else vtk_to_numpy(ghosts) & 1 == 0
is_triangle, is_line = (types == 5) & counted, (types == 3) & counted
corners, offsets = (vtk_to_numpy(a) for a in (grid.GetCells().GetConnectivityArray(), grid.GetCells().GetOffsetsArray()))
triangles = corners[offsets[:-1][is_triangle][:, None] + numpy.arange(3)]  # pieces follow each other, each with its lines
cells = {name: vtk_to_numpy(grid.GetCellData().GetArray(name)) for name in ("region", "marker")}
markers = cells["marker"][is_line]
if sys.argv[1].endswith(".pvtu") and ghosts is None:  # a subsegment between pieces is in both
    numbers = vtk_to_numpy(grid.GetPointData().GetArray("global_number"))
    ends = numpy.sort(numbers[corners[offsets[:-1][is_line][:, None] + numpy.arange(2)]], axis=1)
    markers = markers[numpy.unique(ends, axis=0, return_index=True)[1]]
if sys.argv[1].startswith("ghosts") and (ghosts is None or counted.all()):
    sys.exit("there are no ghost cells")
ghosts = grid.GetPointGhostArray()  # without those that another piece counts
count = len(points) if ghosts is None else int((vtk_to_numpy(ghosts) & 1 == 0).sum())
fields = grid.GetFieldData()
arrays = [fields.GetArray(i) for i in range(fields.GetNumberOfArrays())]
names = {array.GetName(): int(array.GetValue(0)) for array in arrays if array.GetComponentName(1) == "dimension"}
answer(vtk.vtkVersion().GetVTKVersion(), points=count, triangles=int(is_triangle.sum()),
       area=area(points, triangles), regions=counts(cells["region"][is_triangle]), markers=counts(markers), names=names)
