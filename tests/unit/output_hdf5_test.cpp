// What other programs read of these files is tested in tests/readback.
#include <doctest/doctest.h>

#include <filesystem>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "support/damage.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "support/round_trip.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

TEST_CASE("a .h5 reads back as the mesh that was written") {
  check_random_meshes_read_back(".h5");
}

TEST_CASE("an empty mesh and points alone survive in .h5") {
  check_meshes_without_triangles_read_back(".h5");
}

TEST_CASE("a .h5 has an .xdmf beside it that names its arrays") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "a&b.h5";
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  mesh.edges = {{0, 1, 7}, {1, 2, 0}};
  write_mesh(mesh, path);
  CHECK(mesh_files(path) == std::vector<std::string>{path, folder.path() / "a&b.xdmf"});
  CHECK(files_to_read(path) == std::vector<std::string>{path});
  const std::string xdmf = file_bytes(folder.path() / "a&b.xdmf");
  CHECK(xdmf.find("Dimensions=\"1 3\" NumberType=\"Int\" Precision=\"8\" "
                  "Format=\"HDF\">a&amp;b.h5:/viz/topology/cells<") != std::string::npos);
  CHECK(xdmf.find("Dimensions=\"2\" NumberType=\"Int\" Precision=\"4\" Format=\"HDF\">a&amp;b.h5:/tags/facets<") !=
        std::string::npos);
}

TEST_CASE("a .h5 that is cut, or none, is rejected") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.h5";
  write_mesh(RandomMesh(3, 4, 4).mesh(), path);
  const std::string bytes = file_bytes(path);
  for (std::size_t part = 0; part < 50; ++part) {
    replace_file(path, bytes.substr(0, bytes.size() * part / 50));
    CHECK_THROWS_AS((void)read_mesh(path), InputError);
  }
  CHECK_THROWS_AS((void)read_mesh(folder.path() / "none.h5"), FileError);
}

TEST_CASE("a .h5 needs a regular file") {
  CHECK_THROWS_AS(write_mesh({}, "-.h5"), InputError);
}
