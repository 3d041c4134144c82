#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "app/checked_mesh.hpp"
#include "app/mesh_input.hpp"
#include "app/mesh_run.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/size_rule.hpp"
#include "job/request.hpp"
#include "mesh/digest.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;

namespace {

job::Request request_for(const std::string& path) {
  job::Request request;
  request.input.generator = "pipe";
  request.run.method = job::Method::kRounds;
  request.decomposition.subdomains = 12;
  request.output.session = path;
  request.output.quiet = true;
  return request;
}

void require_same(const AdaptiveMesh& a, const AdaptiveMesh& b) {
  CHECK(a.mesh().points == b.mesh().points);
  CHECK(a.mesh().triangles == b.mesh().triangles);
  CHECK(a.report().generation == b.report().generation);
  CHECK(a.report().kept == b.report().kept);
  CHECK(a.report().mended == b.report().mended);
}

/// Two calls, since the second one compares with what the first one noted.
void require_same_future(AdaptiveMesh& saved, AdaptiveMesh& made) {
  require_same(saved, made);
  for (const double x : {0.0, 20.0}) {
    for (AdaptiveMesh* const mesh : {&saved, &made}) {
      std::vector<double> lengths;
      for (const Point& p : mesh->mesh().points) lengths.push_back(4 + 0.3 * std::abs(p.x - x));
      mesh->adapt(lengths);
    }
    CHECK(made.report().kept < 12);
    require_same(saved, made);
  }
}

}  // namespace

TEST_CASE("an adaptive mesh that the program has saved goes on as one of the library") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "flow.h5").string();
  job::Request request = request_for(path);
  MeshOptions options{.subdomains = {.count = 12}};
  SUBCASE("with a bound on area, which stays") {
    request.bounds.area = options.max_area = 40;
  }
  SUBCASE("with a number of triangles, which does not") {
    request.bounds.triangles = options.triangles = 2000;
  }
  SUBCASE("with lengths") {
    request.sizing.expression = "4+abs(x)/5";
    options.size = SizeRule::expression("4+abs(x)/5");
  }
  REQUIRE(app::run_mesh(request, job::kSubdomains, "", "") == 0);
  AdaptiveMesh saved = AdaptiveMesh::load(path);
  AdaptiveMesh made(generate("pipe"), options);
  require_same_future(saved, made);
}

TEST_CASE("a saved adaptive mesh is judged and read by what is in its file") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "flow.kept").string();
  AdaptiveMesh flow(generate("pipe"), {.min_angle = 25, .max_area = 40, .subdomains = {.count = 12}});
  std::vector<double> u, uv;
  for (const Point& p : flow.mesh().points) {
    u.push_back(p.x);
    uv.insert(uv.end(), {p.x, p.y});
  }
  flow.attach("u", u);
  flow.attach("v", uv);
  flow.attach("cells", std::vector<double>(flow.mesh().triangles.size(), 1), FieldPlace::kTriangles,
              Transfer::kConserve);
  flow.adapt(std::vector<double>(flow.mesh().points.size(), 6));
  flow.save(path);
  REQUIRE(app::is_saved_session(path));

  app::CheckedMesh checked(path, {});
  REQUIRE(checked.session() != nullptr);
  CHECK(checked.session()->generation == 1);
  CHECK(checked.session()->plan.bounds.min_angle == 25);
  CHECK(checked.session()->fields.size() == 3);
  const VerifyReport report = checked.verify(&checked.session()->pslg, {.min_angle = 25, .plain = {.area = 40}});
  CHECK(report.accepted());
  CHECK(report.triangles == flow.mesh().triangles.size());
  CHECK(checked.digest() == mesh_digest(flow.mesh()));

  const Mesh mesh = app::read_any_mesh(path, {});
  CHECK(mesh.points == flow.mesh().points);
  CHECK(mesh.triangles == flow.mesh().triangles);
  REQUIRE(mesh.attribute_names == std::vector<std::string>{"u", "v_0", "v_1"});
  TriangleData data;
  CHECK(app::read_any_mesh(path, {}, data).attributes == mesh.attributes);
  REQUIRE(data.size() == 1);
  CHECK(data.at("cells") == std::vector<double>(flow.field("cells").begin(), flow.field("cells").end()));
  const auto first = flow.field("u"), second = flow.field("v");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    CHECK(mesh.attributes[3 * i] == first[i]);
    CHECK(mesh.attributes[3 * i + 1] == second[2 * i]);
    CHECK(mesh.attributes[3 * i + 2] == second[2 * i + 1]);
  }
}
