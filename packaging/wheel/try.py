"""What the wheel must do where there is nothing of ours: mesh, check, draw, and write and read every format. Run in an empty folder."""

import pathlib
import shutil
import subprocess
import sys
import time

start = time.process_time()  # the machine may be busy
import driftmesh  # noqa: E402

seconds = time.process_time() - start
assert seconds < 0.1, f"import took {seconds:.3f} s"
assert "mpi4py" not in sys.modules and "numpy" not in sys.modules

bay = driftmesh.generate("bay", seed=7)
mesh = driftmesh.mesh(bay, min_angle=25, triangles="100k")
report = driftmesh.check(mesh, bay, min_angle=25)
assert report, report
assert mesh.points.shape[1] == 2 and mesh.triangles.shape[1] == 3
cut = driftmesh.mesh(bay, min_angle=25, max_area=2000, subdomains={"count": 8})
assert driftmesh.check(cut, bay, min_angle=25, max_area=2000)

small = driftmesh.mesh(driftmesh.generate("rectangle-hole"), max_area=1e-2)
for picture, begins in (("bay.png", b"\x89PNG"), ("bay.svg", b"<?xml"), ("bay.pdf", b"%PDF")):
    driftmesh.plot(small, picture, title="Angles of 20 to 60 degrees")
    assert pathlib.Path(picture).read_bytes().startswith(begins) and pathlib.Path(picture).stat().st_size > 1000, picture
assert small._repr_png_().startswith(b"\x89PNG")

for name in ("a.vtu", "a.msh", "a.h5", "a.su2", "a.14", "a.gr3", "a.node"):
    small.write(name)
    assert len(driftmesh.read_mesh(name).triangles) == len(small.triangles), name
small.write("a.mesh")
bay.write("bay.poly")
assert len(driftmesh.read("bay.poly").points) == len(bay.points)
square = '{"type": "Polygon", "coordinates": [[[0, 0], [0.01, 0], [0.01, 0.01], [0, 0.01], [0, 0]]]}'
pathlib.Path("square.geojson").write_text(square)
assert len(driftmesh.mesh(driftmesh.read("square.geojson")).triangles) > 0

for name, words in (("mesh_distributed", "MPI"), ("simulate", "MPI")):
    try:
        getattr(driftmesh, name)
    except ImportError as error:
        assert name in str(error) and words in str(error), error
    else:
        raise AssertionError(f"{name} should need MPI")
try:
    driftmesh.read("coast.shp")
except driftmesh.Error as error:
    assert "coast.shp" in str(error)

said = ""
if shutil.which("ldd"):
    module = next(pathlib.Path(driftmesh.__file__).parent.glob("_native*"))
    said = subprocess.run(["ldd", module], capture_output=True, text=True, check=False).stdout
print(f"driftmesh {driftmesh.__version__} on Python {sys.version.split()[0]}: imported in {seconds:.3f} s\n{said}")
