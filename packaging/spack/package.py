# A recipe for Spack: put this folder as packages/driftmesh into a repository of Spack's ("spack repo create"), then
# "spack install driftmesh" or, for the library in one process alone, "spack install driftmesh ~mpi".
from spack.package import *


class Driftmesh(CMakePackage):
    """Guaranteed-quality Delaunay meshes of planar domains, on one core or on many ranks."""

    homepage = "https://example.org/driftmesh"
    git = "https://example.org/driftmesh.git"

    license("BSD-3-Clause")

    version("main", branch="main")

    variant("mpi", default=True, description="Meshes on ranks, simulated clusters, and the program")
    variant("python", default=False, description="The Python package")
    variant("gdal", default=False, description="Shapefiles, GeoPackages and rasters")
    variant("shared", default=True, description="Shared libraries")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    generator("ninja")

    depends_on("boost+serialization")
    depends_on("cairo+png+pdf+svg")
    depends_on("hdf5~mpi")
    depends_on("metis@5:~int64")
    depends_on("nlohmann-json@3.7:")
    depends_on("zlib-api")
    with when("+mpi"):
        depends_on("mpi")
        depends_on("zoltan@3.83:")
        depends_on("cli11@2:")
        depends_on("fmt@9:")
        depends_on("yaml-cpp@0.7:")
    depends_on("gdal@3:", when="+gdal")
    with when("+python"):
        extends("python@3.9:")
        depends_on("py-pybind11@2.10:", type="build")
        depends_on("py-numpy", type=("build", "run"))
        depends_on("py-mpi4py", when="+mpi", type="run")

    conflicts("%gcc@:10", msg="driftmesh takes C++20 with std::from_chars for numbers with fractions")

    def cmake_args(self):
        args = [
            self.define("DRIFTMESH_TESTS", False),
            self.define("DRIFTMESH_REPORT", False),
            self.define("DRIFTMESH_GDAL", "ON" if self.spec.satisfies("+gdal") else "OFF"),
            self.define_from_variant("DRIFTMESH_MPI", "mpi"),
            self.define_from_variant("DRIFTMESH_PYTHON", "python"),
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
        ]
        if self.spec.satisfies("+python"):
            args += [
                self.define("Python_ROOT_DIR", self.spec["python"].prefix),
                self.define("DRIFTMESH_PYTHON_DIR", python_platlib),
            ]
        return args
