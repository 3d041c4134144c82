#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "driftmesh/check.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/mesher.hpp"
#include "driftmesh/repair.hpp"
#include "geojson/read_input.hpp"
#include "oracles/random_polygons.hpp"
#include "property/cases.hpp"
#include "temporary_folder.hpp"
#include "verify/verify.hpp"

// Random sets of polygons that touch, overlap, cross and repeat, from GeoJSON to meshes: the areas of the mesh and of
// its regions are those of an exact oracle, checks accept the mesh, and reject the mesh of any other set.
//
//     polygon_sets_property_test [COUNT [SEED]]    tries the sets SEED, SEED + 1, ...

namespace {

using namespace driftmesh;
using oracles::RandomPolygons;

using Areas = std::map<double, long double>;  // area by region

struct Case {
  Pslg given;
  oracles::PolygonAreas expected;
  long double tolerance = 0;
};

/// Throws Error if the set covers no area.
Case case_of(const RandomPolygons& set) {
  Case made{parse_geojson_input("set.geojson", oracles::geojson_of(set)).pslg, oracles::covered_areas(set.polygons)};
  const long double square = static_cast<long double>(set.unit) * set.unit;
  made.expected.total *= square;
  for (auto& [region, area] : made.expected.regions) area *= square;
  long double largest = 0, length = 0;
  for (const Pslg::Segment& s : made.given.segments) {
    const Point &a = made.given.points[to_index(s.a)], &b = made.given.points[to_index(s.b)];
    largest = std::max<long double>({largest, std::fabs(a.x), std::fabs(a.y)});
    length += std::hypot(b.x - a.x, b.y - a.y);
  }
  made.tolerance = 64 * 0x1p-52L * largest * length;
  return made;
}

Areas areas_of(const Mesh& mesh) {
  Areas areas;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Point &a = mesh.points[to_index(i)], &b = mesh.points[to_index(j)], &c = mesh.points[to_index(k)];
    areas[mesh.regions.empty() ? 0 : mesh.regions[t]] +=
        ((static_cast<long double>(b.x) - a.x) * (c.y - a.y) - (static_cast<long double>(b.y) - a.y) * (c.x - a.x)) / 2;
  }
  return areas;
}

/// What differs, in words, or "".
std::string difference(Areas actual, Areas expected, long double tolerance) {
  for (const auto& [region, area] : expected) actual.try_emplace(region, 0);
  for (const auto& [region, area] : actual)
    if (std::fabs(area - expected[region]) > tolerance)
      return "region " + std::to_string(region) + " covers " + std::to_string(area) + ", not " +
             std::to_string(expected[region]);
  return "";
}

constexpr std::int64_t kMostTriangles = 20'000;

MeshOptions options_for(std::uint64_t seed) {
  return {.min_angle = seed % 16 == 0 ? 20.0 : 0.0,
          .threads = 1,
          .max_triangles = kMostTriangles,
          .subdomains = {.count = 1}};
}

/// The mesh without one connected face.
Mesh without_a_face(const Mesh& mesh, std::uint64_t seed) {
  std::map<std::array<std::int32_t, 2>, std::size_t> left;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) left[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
  for (const Mesh::Edge& edge : mesh.edges) {
    left.erase({edge.a, edge.b});
    left.erase({edge.b, edge.a});
  }
  std::vector<char> removed(mesh.triangles.size());
  std::vector<std::size_t> next{seed % mesh.triangles.size()};
  while (!next.empty()) {
    const std::size_t t = next.back();
    next.pop_back();
    if (removed[t] != 0) continue;
    removed[t] = 1;
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto other = left.find({mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][k]}); other != left.end())
        next.push_back(other->second);
  }
  Mesh rest = mesh;
  rest.triangles.clear();
  rest.regions.clear();
  std::set<std::int32_t> used;
  for (std::size_t t = 0; t < removed.size(); ++t) {
    if (removed[t] != 0) continue;
    rest.triangles.push_back(mesh.triangles[t]);
    used.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
    if (!mesh.regions.empty()) rest.regions.push_back(mesh.regions[t]);
  }
  std::erase_if(rest.edges, [&](const Mesh::Edge& edge) { return !used.contains(edge.a) || !used.contains(edge.b); });
  return rest;
}

/// The set without a hole, with a polygon less, or with two polygons exchanged.
RandomPolygons misread(RandomPolygons set, std::uint64_t seed) {
  auto& polygons = set.polygons;
  const std::size_t p = seed / 3 % polygons.size();
  if (polygons[p].rings.size() > 1 && seed % 3 != 0)
    polygons[p].rings.pop_back();
  else if (polygons.size() > 1 && seed % 3 == 1)
    polygons.erase(polygons.begin() + static_cast<std::ptrdiff_t>(p));
  else
    std::swap(polygons.front(), polygons.back());
  return set;
}

class Trial {
 public:
  explicit Trial(std::uint64_t seed) : seed_(seed), set_(oracles::make_random_polygons(seed)) {}

  std::string run() {
    try {
      case_ = case_of(set_);
      mesh_ = driftmesh::mesh(case_.given, options_for(seed_));
    } catch (const LimitError&) {
      return "";
    } catch (const Error& error) {
      return oracles::covered_areas(set_.polygons).total == 0 ? "" : error.what();
    }
    if (std::string other = difference(areas_of(mesh_), case_.expected.regions, case_.tolerance); !other.empty())
      return other;
    if (const CheckReport report = check(mesh_, case_.given, options_for(seed_)); !report.accepted)
      return "the mesh is " + report.verdict + "\n" + report.text;
    if (check(without_a_face(mesh_, seed_), case_.given, options_for(seed_)).accepted)
      return "a mesh without a face is accepted";
    return try_misread();
  }

 private:
  /// A check that reads polygons wrongly, too, sees it by its own reading.
  std::string try_misread() {
    try {
      const Case other = case_of(misread(set_, seed_));
      if (difference(other.expected.regions, case_.expected.regions, 8 * case_.tolerance).empty()) return "";
      Pslg repaired = other.given;
      repair(repaired);
      const Mesh mesh = driftmesh::mesh(other.given, options_for(1));
      if (check(mesh, case_.given, options_for(1)).accepted) return "the mesh of another set is accepted";
      const VerifyReport report = verify(mesh, repaired, {.plain = {.region_areas = false}, .given = &case_.given});
      if (report.findings.count(Flaw::kWrongPolygons) == 0 && report.polygons_judged)
        return "another reading of the polygons is not noticed";
    } catch (const Error&) {
      // Nothing may be left to mesh.
    }
    return "";
  }

  std::uint64_t seed_;
  RandomPolygons set_;
  Case case_;
  Mesh mesh_;
};

/// The program does the same.
std::string run_program(const RandomPolygons& set) {
  const TemporaryFolder folder;
  const std::string domain = (folder.path() / "set.geojson").string(), mesh = (folder.path() / "mesh.vtu").string();
  std::ofstream(domain) << oracles::geojson_of(set);
  const std::string quiet = " > /dev/null 2>&1", program = DRIFTMESH_PROGRAM;
  if (std::system((program + " mesh " + domain + " --angle 0 -o " + mesh + quiet).c_str()) != 0) return "";
  return std::system((program + " check " + mesh + " " + domain + quiet).c_str()) == 0 ? "" : "the program rejects it";
}

class Sweep {
 public:
  bool run(std::uint64_t first, std::int64_t count) {
    for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) try_one(seed);
    std::printf("%lld sets from %llu on: %lld wrong\n", static_cast<long long>(count),
                static_cast<unsigned long long>(first), static_cast<long long>(wrong_));
    return wrong_ == 0 && saw_all(count);
  }

 private:
  static constexpr std::uint64_t kProgram = 250;

  void try_one(std::uint64_t seed) {
    std::string what;
    const RandomPolygons set = oracles::make_random_polygons(seed);
    note_traits(set);
    try {
      what = Trial(seed).run();
      if (what.empty() && seed % kProgram == 0) what = run_program(set);
    } catch (const std::exception& error) {
      what = std::string("ends with ") + error.what();
    }
    if (what.empty()) return;
    ++wrong_;
    std::printf("set %llu: %s\n%s\n", static_cast<unsigned long long>(seed), what.c_str(),
                oracles::geojson_of(set).c_str());
  }

  void note_traits(const RandomPolygons& set) {
    const auto found = oracles::traits_of(set.polygons);
    (set.general ? general_ : flawed_) += 1;
    for (std::size_t k = 0; k < oracles::kTraits; ++k) (set.general ? in_general_ : in_flawed_)[k] += found[k] ? 1 : 0;
  }

  /// Flawed sets have each trait in one of 40 or more. Valid polygons overlap, and that is all.
  [[nodiscard]] bool saw_all(std::int64_t count) const {
    bool all = true;
    const auto expect = [&](bool is_right, std::size_t k, const std::array<std::int64_t, oracles::kTraits>& seen) {
      if (is_right || count < 500) return;
      std::printf("the generator is wrong: '%s' in %lld sets\n", oracles::trait_name(static_cast<oracles::Trait>(k)),
                  static_cast<long long>(seen[k]));
      all = false;
    };
    for (std::size_t k = 0; k < oracles::kTraits; ++k) {
      const auto trait = static_cast<oracles::Trait>(k);
      const bool may = trait == oracles::Trait::polygons_overlap || trait == oracles::Trait::over_a_hole;
      expect(40 * in_flawed_[k] >= flawed_, k, in_flawed_);
      expect(may || in_general_[k] == 0, k, in_general_);
    }
    expect(4 * in_general_[0] >= general_, 0, in_general_);
    return all;
  }

  std::int64_t wrong_ = 0, general_ = 0, flawed_ = 0;
  std::array<std::int64_t, oracles::kTraits> in_general_{}, in_flawed_{};
};

}  // namespace

int main(int argc, char** argv) {
  constexpr std::int64_t kStandard = 1000;
  const std::int64_t count = argc > 1 ? std::strtoll(argv[1], nullptr, 10) : testing::case_count(kStandard);
  const std::uint64_t seed = argc > 2   ? std::strtoull(argv[2], nullptr, 10)
                             : argc > 1 ? 1
                                        : testing::seeded_generator("polygons")() % 1'000'000'000'000;
  return Sweep().run(seed, count) ? 0 : 1;
}
