import collections
import re
import shutil
import subprocess
import sys
import tempfile

from answer import answer, area, counts

if shutil.which("gmsh") is None:
    print('{"missing": "no program gmsh"}')
    sys.exit(0)
import numpy

STANDARD = ("marker ", "region ")  # groups without names

# What Gmsh has read it writes in its old, simple format.
with tempfile.NamedTemporaryFile(suffix=".msh") as old:
    subprocess.run(["gmsh", sys.argv[1], "-0", "-format", "msh22", "-o", old.name], check=True, capture_output=True)
    lines = open(old.name).read().splitlines()
section = lambda name: lines[lines.index("$" + name) + 2: lines.index("$End" + name)]
names = {tuple(map(int, line.split()[:2])): line.split('"')[1] for line in section("PhysicalNames")}
value = lambda dimension, tag: names[dimension, tag].split()[1] if names[dimension, tag].startswith(STANDARD) else tag
rows = [line.split() for line in section("Nodes")]
place = {row[0]: i for i, row in enumerate(rows)}
points = numpy.array([[float(word) for word in row[1:]] for row in rows])
elements = [line.split() for line in section("Elements")]
of_type = lambda kind: [element for element in elements if element[1] == kind]
triangles = numpy.array([[place[node] for node in element[-3:]] for element in of_type("2")])
version = subprocess.run(["gmsh", "--version"], capture_output=True, text=True)
answer((version.stdout + version.stderr).strip(), points=len(points), triangles=len(triangles), area=area(points, triangles),
       regions=counts(value(2, int(element[3])) for element in of_type("2")),
       markers=counts(value(1, int(element[3])) for element in of_type("1")),
       names={name: tag for (_, tag), name in names.items() if not name.startswith(STANDARD)})
