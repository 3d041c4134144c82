#include <doctest/doctest.h>

#include <fstream>
#include <string>

#include "driftmesh/error.hpp"
#include "io/pvd_file.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

std::string pvd_text(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" + content +
         "</Collection>\n</VTKFile>\n";
}

std::string data_set(const std::string& time, const std::string& file) {
  return "<DataSet timestep=\"" + time + "\" group=\"\" part=\"0\" file=\"" + file + "\"/>\n";
}

}  // namespace

TEST_CASE("the meshes of a .pvd come by time, from its own folder") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "flow.pvd").string();
  std::ofstream(path) << pvd_text(data_set("0.5", "late.vtu") + data_set("0", "a&amp;b.vtu") +
                                  data_set("1e-3", "sub/early.pvtu"));
  const std::vector<PvdMesh> meshes = read_pvd(path);
  REQUIRE(meshes.size() == 3);
  CHECK(meshes[0].path == (folder.path() / "a&b.vtu").string());
  CHECK(meshes[1].path == (folder.path() / "sub/early.pvtu").string());
  CHECK(meshes[1].time == 1e-3);
  CHECK(meshes[2].time == 0.5);
}

TEST_CASE("a .pvd that cannot be played is refused") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "flow.pvd").string();
  const auto refused = [&](const std::string& text, const std::string& why) {
    std::ofstream(path) << text;
    CHECK(error_text<InputError>([&] { (void)read_pvd(path); }).find(why) != std::string::npos);
  };
  refused(pvd_text(""), "names no meshes");
  refused(pvd_text(data_set("now", "a.vtu")), ":4: needs timestep");
  refused(pvd_text(data_set("inf", "a.vtu")), ":4: needs timestep");
  refused(pvd_text(data_set("1 s", "a.vtu")), ":4: needs timestep");
  refused(pvd_text(data_set("0", "")), ":4: has a DataSet without file");
  refused(pvd_text(data_set("0", "a.vtu") + data_set("0", "b.vtu")), "several parts of one moment");
  refused(pvd_text(data_set("0", "../a.vtu")), ":4: names the mesh ../a.vtu, outside of its own folder");
  refused("<VTKFile type=\"UnstructuredGrid\"></VTKFile>\n", "is not of type Collection");
  refused("<VTKFile type=\"Collection\"><Collection>" + data_set("0", "a.vtu"), "flow.pvd");
  std::ofstream(path) << pvd_text(data_set("0", "../a.vtu"));
  CHECK(read_pvd(path, {.allow_outside = true}).size() == 1);
}
