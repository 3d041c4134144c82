// What other programs read of these files is tested in tests/readback.
#include <doctest/doctest.h>
#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "support/damage.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

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

namespace {

/// Replaces an array of a .h5 by what `make` puts in its place, given the file and the name.
void replace_array(const std::string& path, const std::string& array,
                   const std::function<void(hid_t file, const char* name)>& make) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, array.c_str(), H5P_DEFAULT);
  make(file, array.c_str());
  H5Fclose(file);
}

/// Puts an array of doubles with these rows and two columns there, as the creation property list wants it.
void create_doubles(hid_t file, const char* name, hsize_t rows, hid_t creation) {
  const hsize_t extent[]{rows, 2};
  const hid_t space = H5Screate_simple(2, extent, nullptr);
  H5Dclose(H5Dcreate(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  H5Sclose(space);
  H5Pclose(creation);
}

}  // namespace

TEST_CASE("a .h5 leads to no other file") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.h5", other = folder.path() / "elsewhere.h5",
                    raw = folder.path() / "raw.bin";
  const Mesh mesh = RandomMesh(3, 4, 4).mesh();
  const hsize_t rows = mesh.points.size();
  write_mesh(mesh, other);
  replace_file(raw, std::string(16 * rows, '\0'));
  const std::string points = "/geometry/vertices";
  const std::vector<std::pair<const char*, std::function<void(hid_t, const char*)>>> leads{
      {"an external link",
       [&](hid_t file, const char* name) {
         H5Lcreate_external(other.c_str(), points.c_str(), file, name, H5P_DEFAULT, H5P_DEFAULT);
       }},
      {"a link to an external link",
       [&](hid_t file, const char* name) {
         H5Lcreate_external(other.c_str(), points.c_str(), file, "/behind", H5P_DEFAULT, H5P_DEFAULT);
         H5Lcreate_soft("/behind", file, name, H5P_DEFAULT, H5P_DEFAULT);
       }},
      {"a group elsewhere",
       [&](hid_t file, const char*) {
         H5Ldelete(file, "/geometry", H5P_DEFAULT);
         H5Lcreate_external(other.c_str(), "/geometry", file, "/geometry", H5P_DEFAULT, H5P_DEFAULT);
       }},
      {"values elsewhere",
       [&](hid_t file, const char* name) {
         const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
         H5Pset_external(creation, raw.c_str(), 0, H5F_UNLIMITED);
         create_doubles(file, name, rows, creation);
       }},
      {"a virtual array", [&](hid_t file, const char* name) {
         const hsize_t extent[]{rows, 2};
         const hid_t creation = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(2, extent, nullptr);
         H5Pset_virtual(creation, space, other.c_str(), points.c_str(), space);
         H5Sclose(space);
         create_doubles(file, name, rows, creation);
       }}};
  for (const auto& [what, make] : leads) {
    CAPTURE(what);
    write_mesh(mesh, path);
    replace_array(path, points, make);
    CHECK_THROWS_WITH_AS((void)read_mesh(path), doctest::Contains("from another file"), InputError);
  }
  write_mesh(mesh, path);
  replace_array(path, points, [&](hid_t file, const char* name) {
    H5Lcreate_soft("/VTKHDF/Points", file, name, H5P_DEFAULT, H5P_DEFAULT);
  });
  CHECK_THROWS_WITH_AS((void)read_mesh(path), doctest::Contains("x 3 values, not"), InputError);
}
