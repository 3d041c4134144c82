#include <doctest/doctest.h>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "support/damage.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

TEST_CASE("a .su2 has triangles, points, and the boundary by its markers, but no segments inside") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.su2";
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {1, 0.5}, {0, 0.1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.edges = {{0, 1, 7}, {1, 2, -2}, {2, 0, 5}, {2, 3, 7}, {3, 0, 7}};
  write_mesh(mesh, path);
  CHECK(file_bytes(path) ==
        "NDIME= 2\n"
        "NELEM= 2\n5 0 1 2 0\n5 0 2 3 1\n"
        "NPOIN= 4\n0 0 0\n1 0 1\n1 0.5 2\n0 0.1 3\n"
        "NMARK= 2\n"
        "MARKER_TAG= -2\nMARKER_ELEMS= 1\n3 1 2\n"
        "MARKER_TAG= 7\nMARKER_ELEMS= 3\n3 0 1\n3 2 3\n3 3 0\n");
  CHECK_THROWS_WITH_AS((void)read_mesh(path), doctest::Contains("is written, but not read"), InputError);
}
