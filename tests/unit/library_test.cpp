#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "api/library_request.hpp"
#include "driftmesh/driftmesh.hpp"
#include "job/keys.hpp"
#include "mesh/digest.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

// The library's functions for meshes in one process.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

const Pslg& plate() {
  static const Pslg input = generate_rectangle_hole({});
  return input;
}

std::string error_of_options(const MeshOptions& options) {
  return error_text([&] { static_cast<void>(mesh(plate(), options)); });
}

bool accepted(const Mesh& made, const MeshOptions& options) {
  VerifyOptions asked;
  asked.min_angle = options.min_angle;
  asked.plain.area = options.max_area;
  return verify(made, plate(), asked).accepted();
}

class Halving final : public SizeField {
 public:
  [[nodiscard]] double edge_length(const Point& p) const override { return p.x < 1 ? 0.1 : 0.05; }
};

}  // namespace

TEST_CASE("a mesh in one piece meets its bounds and is reproducible") {
  const MeshOptions options{.min_angle = 28, .max_area = 1e-3};
  const Mesh made = mesh(plate(), options);
  CHECK(made.triangles.size() > 1000);
  CHECK(made.subdomains.empty());
  CHECK(accepted(made, options));
  CHECK(mesh_digest(mesh(plate(), options)) == mesh_digest(made));
}

TEST_CASE("a mesh in subdomains meets its bounds and lists the subdomain of each triangle") {
  for (const Presplit presplit : {Presplit::kOn, Presplit::kOff}) {
    MeshOptions options{.max_area = 1e-3, .subdomains = {.count = 7, .presplit = presplit}};
    const Mesh made = mesh(plate(), options);
    CHECK(accepted(made, options));
    CHECK(std::set(made.subdomains.begin(), made.subdomains.end()).size() == 7);
    options.subdomains.sleep = true;
    options.subdomains.slice = 1000;
    options.subdomains.order = WorkOrder::kLargest;
    if (presplit == Presplit::kOn) CHECK(mesh_digest(mesh(plate(), options)) == mesh_digest(made));
  }
}

TEST_CASE("a large mesh is made in subdomains, the same by any number of threads") {
  MeshOptions options{.triangles = 600'000};
  const Mesh made = mesh(plate(), options);
  CHECK(accepted(made, {}));
  CHECK(std::set(made.subdomains.begin(), made.subdomains.end()).size() > 20);
  for (const int threads : {1, 2, 3}) {
    options.threads = threads;
    CHECK(mesh_digest(mesh(plate(), options)) == mesh_digest(made));
  }
  options.subdomains.count = 1;
  CHECK(mesh(plate(), options).subdomains.empty());
}

TEST_CASE("a size function is called by other threads only if they are asked for") {
  for (const int threads : {0, 3}) {
    std::mutex mutex;
    std::set<std::thread::id> callers;
    const auto size = [&](const Point&) {
      const std::scoped_lock lock(mutex);
      callers.insert(std::this_thread::get_id());
      return 0.02;
    };
    CHECK(mesh(plate(), {.size = size, .threads = threads, .subdomains = {.count = 60}}).triangles.size() > 10'000);
    CHECK(callers.contains(std::this_thread::get_id()));
    CHECK((callers.size() > 1) == (threads > 1));
  }
  const std::thread::id calling = std::this_thread::get_id();
  const auto fails_elsewhere = [&](const Point&) {
    if (std::this_thread::get_id() != calling) throw std::domain_error("not here");
    return 0.02;
  };
  CHECK_THROWS_AS(
      static_cast<void>(mesh(plate(), {.size = fails_elsewhere, .threads = 2, .subdomains = {.count = 60}})),
      std::domain_error);
}

TEST_CASE("an input is repaired first") {
  Pslg twice = plate();
  twice.points.push_back(twice.points.front());
  CHECK(mesh_digest(mesh(twice)) == mesh_digest(mesh(plate())));
  CHECK_THROWS_AS(static_cast<void>(mesh(Pslg{})), InputError);
}

TEST_CASE("a size function bounds the triangles, whatever kind of callable it is") {
  const Halving halving;
  const Mesh by_object = mesh(plate(), {.size = std::ref(halving)});
  const Mesh by_lambda = mesh(plate(), {.size = [](const Point& p) { return p.x < 1 ? 0.1 : 0.05; }});
  CHECK(mesh_digest(by_object) == mesh_digest(by_lambda));
  CHECK(by_object.triangles.size() > 2 * mesh(plate()).triangles.size());
  VerifyOptions asked;
  asked.size = &halving;
  CHECK(verify(by_object, plate(), asked).accepted());
}

TEST_CASE("a size function is looked up between corners, as densely as asked") {
  const auto spot = [](const Point& p) { return std::hypot(p.x - 0.61, p.y - 0.37) < 0.002 ? 0.001 : 0.4; };
  const std::size_t found = mesh(plate(), {.size = spot}).triangles.size();
  CHECK(found > 50 + mesh(plate(), {.size = spot, .size_resolution = 1}).triangles.size());
  CHECK(found < 2000);
  CHECK(mesh(plate(), {.size = spot, .subdomains = {.count = 5}}).triangles.size() > found / 2);
}

TEST_CASE("invalid values of a size function") {
  for (const double length : {0.0, -1.0, std::nan("")})
    CHECK(error_of_options({.size = [=](const Point&) { return length; }}).find("must be positive") !=
          std::string::npos);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  CHECK(mesh_digest(mesh(plate(), {.size = [](const Point&) { return kNone; }})) == mesh_digest(mesh(plate())));
}

TEST_CASE("exceptions of callables pass through") {
  for (const std::int32_t subdomains : {0, 5}) {
    MeshOptions options{.max_area = 1e-3, .subdomains = {.count = subdomains}};
    options.size = [](const Point&) -> double { throw std::domain_error("size"); };
    CHECK_THROWS_WITH_AS(static_cast<void>(mesh(plate(), options)), "size", std::domain_error);
    options.size = {};
    options.progress = [](const Progress&) -> bool { throw std::domain_error("progress"); };
    CHECK_THROWS_WITH_AS(static_cast<void>(mesh(plate(), options)), "progress", std::domain_error);
  }
}

TEST_CASE("progress is reported, and can cancel") {
  for (const std::int32_t subdomains : {0, 5}) {
    std::vector<Progress> told;
    MeshOptions options{.max_area = 1e-5, .subdomains = {.count = subdomains}};
    options.progress = [&](const Progress& progress) {
      told.push_back(progress);
      return true;
    };
    const Mesh made = mesh(plate(), options);
    REQUIRE(told.size() > 2);
    CHECK(std::is_sorted(told.begin(), told.end(), [](auto& a, auto& b) { return a.triangles < b.triangles; }));
    CHECK(told.back().triangles == static_cast<std::int64_t>(made.triangles.size()));
    CHECK(told.back().forecast == doctest::Approx(static_cast<double>(made.triangles.size())).epsilon(0.1));

    std::size_t calls = 0;
    options.progress = [&](const Progress&) { return ++calls < 3; };
    CHECK_THROWS_AS(static_cast<void>(mesh(plate(), options)), Cancelled);
    CHECK(calls == 3);
  }
}

TEST_CASE("limits end the work") {
  CHECK_THROWS_AS(static_cast<void>(mesh(plate(), {.max_area = 1e-6, .max_triangles = 1000})), LimitError);
  CHECK_THROWS_AS(static_cast<void>(mesh(plate(), {.max_area = 1e-6, .max_memory = 1 << 20})), LimitError);
  MeshOptions in_parts{.max_area = 1e-6, .max_triangles = 1000, .subdomains = {.count = 5}};
  CHECK_THROWS_AS(static_cast<void>(mesh(plate(), in_parts)), LimitError);
}

TEST_CASE("options are checked against the table of keys, and errors name them as the caller knows them") {
  CHECK(error_of_options({.min_angle = 50}) ==
        "MeshOptions::min_angle is 50; it must be at most 34: above that, refinement may not terminate");
  CHECK(error_of_options({.max_area = -1}).starts_with("MeshOptions::max_area "));
  CHECK(error_of_options({.subdomains = {.count = 4, .skew = 1.5}}).starts_with("MeshOptions::subdomains.skew "));
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  for (const MeshOptions& options :
       {MeshOptions{.min_angle = kNoNumber}, MeshOptions{.max_area = kNoNumber}, MeshOptions{.triangles = kNoNumber}})
    CHECK(error_of_options(options).find(" is not a number") != std::string::npos);
  CHECK(error_of_options({.subdomains = {.count = 4, .skew = kNoNumber}}) ==
        "MeshOptions::subdomains.skew is not a number; give one");
  // Advice refers only to options that the library has.
  CHECK(error_of_options({.max_area = 1, .triangles = 100}) ==
        "MeshOptions::triangles cannot be combined with MeshOptions::max_area; remove one of them");
  const std::string too_many = error_of_options({.max_area = 1e-5, .max_triangles = 100});
  CHECK(too_many.find("MeshOptions::max_triangles") != std::string::npos);
  CHECK(too_many.find("--") == std::string::npos);
  CHECK(error_of_options({.subdomains = {.count = 4, .presplit = Presplit::kOn}}) ==
        "MeshOptions::subdomains.presplit is on, but nothing says how long the pieces of interfaces may be; give "
        "MeshOptions::max_area, MeshOptions::triangles or MeshOptions::size, or remove it");
  // Options that do not apply are rejected.
  CHECK(error_of_options({.subdomains = {.slice = 100}}).starts_with("MeshOptions::subdomains.slice "));
  CHECK(error_of_options({.subdomains = {.count = 4}, .balance = {.policy = "greedy"}})
            .starts_with("MeshOptions::balance.policy "));
  CHECK(error_of_options({.subdomains = {.count = 4}, .ranks = {.speeds = {1}}})
            .starts_with("MeshOptions::ranks.speeds "));
}

TEST_CASE("every key that the library has is an option, with the same default") {
  std::set<std::string> options;
  job::Request request;
  visit_options(MeshOptions{}, request,
                [&](const char* key, const char*, const auto&, const auto&) { options.insert(key); });
  const job::Request defaults = request_of({});
  for (const job::Key& key : job::keys()) {
    const bool offered = (key.entry_points & job::kLibrary) != 0;
    CHECK_MESSAGE(options.count(key.name) == (offered ? 1 : 0), key.name);
    CHECK_MESSAGE(key.load(defaults) == key.standard, key.name);
  }
}

TEST_CASE("a decomposition can be made once and used again") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "plate.dec").string();
  const MeshOptions cut{.max_area = 1e-3, .subdomains = {.count = 6}};
  const auto decomposition = cut_domain(plate(), cut);
  CHECK(subdomains_of(*decomposition) == 6);
  save_decomposition(*decomposition, plate(), file);
  const std::uint64_t digest = mesh_digest(mesh(plate(), cut));
  for (const auto& given : {decomposition, load_decomposition(file, plate())}) {
    CHECK(mesh_digest(mesh(plate(), {.max_area = 1e-3, .subdomains = {.given = given}})) == digest);
    CHECK_THROWS_AS(static_cast<void>(mesh(generate_rectangle_hole({.radius = 0.2}), {.subdomains = {.given = given}})),
                    InputError);
    CHECK(error_of_options({.subdomains = {.count = 6, .given = given}}).starts_with("MeshOptions::subdomains.count "));
  }
}

TEST_CASE("threads that make meshes concurrently get the same meshes as alone") {
  std::vector<MeshOptions> kinds(3);
  kinds[0] = {.max_area = 1e-4};
  kinds[1] = {.max_area = 1e-4, .subdomains = {.count = 40}};  // METIS and packed forms take part
  kinds[1].subdomains.sleep = true;
  kinds[2] = {.size = [](const Point& p) { return 0.01 + 0.02 * p.x; }, .subdomains = {.count = 11}};
  std::vector<std::uint64_t> alone;
  for (const MeshOptions& options : kinds) alone.push_back(mesh_digest(mesh(plate(), options)));

  constexpr int kTimes = 3;
  std::vector<std::vector<std::uint64_t>> together(2 * kinds.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < together.size(); ++i)
    threads.emplace_back([&, i] {
      for (int n = 0; n < kTimes; ++n) together[i].push_back(mesh_digest(mesh(plate(), kinds[i % kinds.size()])));
    });
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 0; i < together.size(); ++i)
    CHECK(together[i] == std::vector<std::uint64_t>(kTimes, alone[i % kinds.size()]));
}

TEST_CASE("a check of a mesh finds that it meets its requirements, and what is wrong with others") {
  const MeshOptions options{.min_angle = 28, .max_area = 1e-2};
  Mesh made = mesh(plate(), options);
  const CheckReport good = check(made, plate(), options);
  CHECK_MESSAGE(good.accepted, good.text);
  CHECK(good.findings.empty());
  CHECK(good.verdict.starts_with("accepted"));
  CHECK(good.triangles == static_cast<std::int64_t>(made.triangles.size()));
  CHECK(good.smallest_angle >= 28);
  CHECK(good.largest_area <= 1e-2);
  CHECK(check(made).accepted);

  CHECK_FALSE(check(made, {.max_area = 1e-3}).accepted);
  CHECK_FALSE(check(made, {.size = [](const Point&) { return 0.01; }}).accepted);
  CHECK(error_text([&] { static_cast<void>(check(made, {.min_angle = 50})); }).find("MeshOptions::min_angle") !=
        std::string::npos);
  std::swap(made.triangles[3][0], made.triangles[3][1]);
  const CheckReport bad = check(made, plate(), options);
  CHECK_FALSE(bad.accepted);
  REQUIRE_FALSE(bad.findings.empty());
  CHECK(bad.findings.front().kind == "not counterclockwise");
  CHECK(bad.findings.front().count == 1);
  CHECK(bad.findings.front().examples.size() == 1);
}

TEST_CASE("a check repairs the input as the mesher does, and knows its rule for holes") {
  Pslg rings = plate();
  rings.holes.clear();
  rings.points.push_back(rings.points.front());
  const MeshOptions nested{.holes = HoleRule::kNested};
  const Mesh made = mesh(rings, nested);
  CHECK(check(made, rings, nested).accepted);
  CHECK_FALSE(check(made, rings).accepted);
}

TEST_CASE("inputs are generated by their names") {
  for (const std::string& name : generator_names()) {
    std::map<std::string, std::string> standard;
    for (const GeneratorParameter& parameter : generator_parameters(name)) {
      CHECK_FALSE(parameter.help.empty());
      standard[parameter.name] = parameter.standard;
    }
    CHECK(generate(name, standard).points == generate(name).points);
  }
  CHECK(generate("fan", {{"wedges", "3"}}).points == generate_fan({.wedges = 3}).points);
  CHECK(error_text([] { static_cast<void>(generator_parameters("fna")); }).find("'fan'") != std::string::npos);
}

TEST_CASE("errors tell their file and line") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "bad.poly").string(), missing = path + ".missing.poly";
  std::ofstream(path) << "3 2 0 0\n1 0 0\n2 x 0\n3 0 y\n";
  try {
    static_cast<void>(read_poly(path));
    FAIL("it was read");
  } catch (const InputError& error) {
    CHECK(error.place().file == path);
    CHECK(error.place().line == 3);
  }
  try {
    static_cast<void>(read_poly(missing));
    FAIL("it was read");
  } catch (const FileError& error) {
    CHECK(error.file() == missing);
  }
}

TEST_CASE("sizes on a mesh are linear on its triangles, and graded if asked for") {
  const Mesh coarse = mesh(plate(), {.max_area = 1e-2});
  std::vector<double> lengths;
  for (const Point& p : coarse.points) lengths.push_back(0.02 + 0.05 * p.x);
  const auto size = size_on_mesh(coarse, lengths);
  CHECK(size->edge_length({0.3, 0.2}) == doctest::Approx(0.035));
  const MeshOptions options{.size = std::ref(*size)};
  CHECK(check(mesh(plate(), options), plate(), options).accepted);

  std::vector<double> steep(coarse.points.size(), 1);
  steep.front() = 0.01;
  const Point& at = coarse.points.front();
  CHECK(size_on_mesh(coarse, steep, 0.1)->edge_length({1 + (1 - at.x) / 2, 0.1}) < 0.4);
  for (const double length : {0.0, -1.0, std::nan("")}) {
    steep.front() = length;
    CHECK(error_text([&] { static_cast<void>(size_on_mesh(coarse, steep)); }) != "no error");
  }
  steep.pop_back();
  CHECK(error_text([&] { static_cast<void>(size_on_mesh(coarse, steep)); }).find("one for each") != std::string::npos);
}
