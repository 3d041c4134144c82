#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/further_cut.hpp"
#include "decompose/with_cuts.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/exceptions.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "support/prepared_mesh.hpp"
#include "support/refine_together.hpp"

// Subdomains of a decomposition that has been refined are cut further: what is around them stays, and what comes of it
// is a decomposition that refines.

using namespace driftmesh;
using namespace driftmesh::oracles;
using testing::prepared;

namespace {

/// Short edges at one place.
class Focus final : public SizeField {
 public:
  Focus(const Point& at, double least) : at_(at), least_(least) {}
  [[nodiscard]] double edge_length(const Point& p) const override {
    return least_ + 0.3 * std::sqrt(squared_distance(p, at_));
  }

 private:
  Point at_;
  double least_;
};

/// The cuts of a subdomain and a neighbor, which travel as bytes.
std::vector<FurtherCut> cuts_of(const Decomposition& d, const testing::RefinedTogether& refined, SubdomainId s,
                                const QualityBounds& bounds, std::int32_t parts) {
  std::vector<SubdomainId> both{s};
  for (const GlobalRootId r : d.roots_of(s))
    if (both.size() == 1 && d.roots[r].is_interface()) both.push_back(d.roots[r].across_from(s));
  std::ranges::sort(both);
  std::vector<FurtherCut> cuts;
  for (const SubdomainId one : both) {
    const auto cut = cut_further(d, one, refined.parts[one], bounds, 500, parts);
    if (!cut) continue;
    const Bytes bytes = to_bytes(*cut);
    ByteReader reader(bytes);
    cuts.push_back(further_cut_from(reader));
    CHECK(reader.at_end());
  }
  return cuts;
}

/// Where the decomposition has its input segments, as pieces between points that both decompositions have.
double length_of_segments(const Decomposition& d) {
  double length = 0;
  for (const Decomposition::Root& r : d.roots)
    if (!r.separator) length += std::sqrt(squared_distance(d.points[r.a], d.points[r.b]));
  return length;
}

double area_of(const Decomposition& d, const std::vector<SubdomainId>& some) {
  double area = 0;
  for (const SubdomainId s : some) {
    const SubdomainMesh part = subdomain_triangulation(d, s);
    area += summarize_angles(part.mesh).total_area;
  }
  return area;
}

/// Points that were put on roots, each of which refinement had put there.
std::size_t points_out_of_nowhere(const Decomposition& before, const CutFurther& after,
                                  const testing::RefinedTogether& refined) {
  std::set<std::array<double, 2>> there;
  for (const SubdomainMesh& part : refined.parts)
    for (const Point& p : part.mesh.points) there.insert({p.x, p.y});
  std::size_t wrong = 0;
  for (const auto& [root, intervals] : after.renamed) {
    wrong += intervals.size() < 2 || intervals.front().root != root;
    GlobalPointId at = before.roots[root].a;
    for (const RootInterval& interval : intervals) {
      const Decomposition::Root& piece = after.broken.roots[interval.root];
      wrong += piece.a != at && piece.b != at;
      at = piece.a == at ? piece.b : piece.a;
      const Point& p = after.broken.points[at];
      wrong += !there.contains({p.x, p.y});
    }
    wrong += at != before.roots[root].b;
  }
  return wrong;
}

}  // namespace

TEST_CASE("subdomains are cut further where refinement has put points") {
  std::size_t divided = 0, broken = 0, refused = 0;
  std::mt19937_64 seeds = testing::seeded_generator("further cuts");
  for (std::int64_t i = 0; testing::more_cases(i, 40, divided > 20 && broken > 10); ++i) {
    const std::uint64_t seed = seeds();
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Triangulation mesh = prepared(make_random_pslg(random(), make_random_shape(random())).input);
    const double area = summarize_angles(mesh).total_area;
    QualityBounds bounds{.min_angle = 20, .plain = {.area = area / 400}};
    DecomposeOptions options{.subdomains = static_cast<std::int32_t>(2 + random() % 6), .bounds = bounds};
    Decomposition d;
    try {
      d = decompose(mesh, options);
    } catch (const Error&) {
      continue;  // no room for so many
    }
    const testing::RefinedTogether refined = testing::refine_together(d, bounds);
    REQUIRE(refined.complete);
    const auto s = static_cast<SubdomainId>(random() % d.size());
    const Focus focus(d.points[d.roots[d.roots_of(s)[0]].a], 0.01 * std::sqrt(area));
    bounds.size = &focus;
    const std::vector<FurtherCut> cuts = cuts_of(d, refined, s, bounds, static_cast<std::int32_t>(2 + random() % 5));
    if (cuts.empty()) {
      ++refused;
      continue;
    }
    const CutFurther after = with_cuts(d, cuts);
    const DecompositionReport before = check_decomposition(after.broken);
    CHECK((before.valid() ? "" : before.problems[0]) == "");
    const DecompositionReport report = check_decomposition(after.divided);
    CHECK((report.valid() ? "" : report.problems[0]) == "");
    CHECK(report.area == doctest::Approx(area).epsilon(1e-9));
    CHECK(length_of_segments(after.divided) == doctest::Approx(length_of_segments(d)).epsilon(1e-12));
    CHECK(points_out_of_nowhere(d, after, refined) == 0);
    std::map<SubdomainId, std::vector<SubdomainId>> parts;
    for (const SubdomainId part : ids_of(after.whole_of)) parts[after.whole_of[part]].push_back(part);
    CHECK(parts.size() == d.size());
    for (const auto& [whole, of_whole] : parts) {
      CHECK(of_whole.front() == whole);
      CHECK(area_of(after.divided, of_whole) == doctest::Approx(area_of(d, {whole})).epsilon(1e-9));
      CHECK(area_of(after.with_separators, {whole}) == doctest::Approx(area_of(d, {whole})).epsilon(1e-9));
    }
    const testing::RefinedTogether again = testing::refine_together(after.divided, bounds);
    CHECK(again.complete);
    CHECK(again.refused == 0);
    CHECK(again.not_conforming == std::vector<std::string>{});
    divided += cuts.size();
    broken += after.renamed.size();
  }
  MESSAGE(divided << " cut, " << broken << " roots broken, " << refused << " refused");
  CHECK(divided > 20);
  CHECK(broken > 10);
}
