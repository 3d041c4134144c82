import contextlib
import io
import sys

from answer import answer, area, counts, import_or_say

meshio = import_or_say("meshio")
with contextlib.redirect_stdout(io.StringIO()):
    mesh = meshio.read(sys.argv[1])
import numpy

triangles = mesh.get_cells_type("triangle")
facts = {"points": len(mesh.points), "triangles": len(triangles), "area": area(mesh.points, triangles)}
if sys.argv[1].endswith(".vtu"):
    facts["regions"] = counts(mesh.get_cell_data("region", "triangle"))
    facts["markers"] = counts(mesh.get_cell_data("marker", "line"))
    facts["names"] = {name: int(array.ravel()[0]) for name, array in mesh.field_data.items()}
elif sys.argv[1].endswith(".su2"):
    facts["boundary"] = counts(mesh.get_cell_data("su2:tag", "line"))
elif sys.argv[1].endswith(".msh"):
    standard = ("marker ", "region ")  # groups without names
    value_of = {(dimension, tag): name.split()[1] if name.startswith(standard) else tag
                for name, (tag, dimension) in mesh.field_data.items()}
    facts["names"] = {name: int(tag) for name, (tag, _) in mesh.field_data.items() if not name.startswith(standard)}
    for fact, kind, dimension in (("regions", "triangle", 2), ("markers", "line", 1)):
        facts[fact] = counts(value_of[dimension, tag] for tag in mesh.get_cell_data("gmsh:physical", kind))
answer(meshio.__version__, **facts)
