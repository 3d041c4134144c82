#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "pslg/generators.hpp"
#include "pslg/noise.hpp"
#include "pslg/open_boundary.hpp"
#include "pslg/seeded_random.hpp"
#include "support/error_text.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

const double kPiHere = std::acos(-1.0);

/// Signed: boundaries are counterclockwise and holes clockwise, so all segments together run around the domain.
double area(const Pslg& pslg) {
  double twice = 0;
  const Point o = pslg.points[0];
  for (const Pslg::Segment& s : pslg.segments) {
    const Point a = pslg.points[s.a], b = pslg.points[s.b];
    twice += (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
  }
  return twice / 2;
}

std::map<std::int32_t, int> marker_counts(const Pslg& pslg) {
  std::map<std::int32_t, int> counts;
  for (const Pslg::Segment& s : pslg.segments) ++counts[s.marker];
  return counts;
}

/// The number of segments that a ray from p to the east crosses.
int crossings_east(const Pslg& pslg, const Point& p) {
  int count = 0;
  for (const Pslg::Segment& s : pslg.segments) {
    const Point a = pslg.points[s.a], b = pslg.points[s.b];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) ++count;
  }
  return count;
}

/// Checks that hold for every kind with a boundary: planar, loops only, holes inside their loops.
void check_closed_model(const Pslg& pslg) {
  Pslg copy = pslg;
  const RepairReport report = repair(copy);
  CHECK(report.summary() == "");
  CHECK(find_open_boundary(pslg).open_ends.empty());
  CHECK(pslg.points.size() == pslg.segments.size());
  for (const Point& hole : pslg.holes) CHECK(crossings_east(pslg, hole) % 2 == 0);
  CHECK(area(pslg) > 0);
}

bool same(const Pslg& a, const Pslg& b) {
  return a.points == b.points && a.segments == b.segments && a.holes == b.holes;
}

}  // namespace

TEST_CASE("pipe: bore and channels, area of the ring less the channels") {
  PipeOptions o;
  const Pslg pslg = generate_pipe(o);
  check_closed_model(pslg);
  CHECK(pslg.holes.size() == 9);
  CHECK(marker_counts(pslg).size() == 10);
  // Bending a channel keeps its area, because it is centered on the circle along which widths are measured.
  const double channel = o.channel_depth * o.channel_width - (4 - kPiHere) * o.fillet * o.fillet;
  const double ring = kPiHere * (o.outer_radius * o.outer_radius - o.bore_radius * o.bore_radius);
  CHECK(area(pslg) == doctest::Approx(ring - 8 * channel).epsilon(2e-3));
  for (const std::int32_t channels : {0, 1, 3, 11}) {
    o.channels = channels;
    const Pslg other = generate_pipe(o);
    check_closed_model(other);
    CHECK(other.holes.size() == channels + 1);
  }
  for (const Pslg::Segment& s : pslg.segments)
    CHECK(std::hypot(pslg.points[s.a].x - pslg.points[s.b].x, pslg.points[s.a].y - pslg.points[s.b].y) < 1.25 * o.edge);
}

TEST_CASE("cylinder-flow: markers of the five sides, area of the rectangle less the half disc") {
  const CylinderFlowOptions o;
  const Pslg pslg = generate_cylinder_flow(o);
  check_closed_model(pslg);
  CHECK(marker_counts(pslg) == std::map<std::int32_t, int>{{1, 28}, {2, 28}, {3, 50}, {4, 50}, {5, 128}});
  CHECK(area(pslg) == doctest::Approx(50 * 28 - kPiHere / 8).epsilon(1e-6));
}

TEST_CASE("rectangle-hole, comb and holes: area and counts") {
  const Pslg rectangle = generate_rectangle_hole({});
  check_closed_model(rectangle);
  CHECK(rectangle.points.size() == 36);
  CHECK(area(rectangle) == doctest::Approx(2 - 16 * 0.0625 * std::sin(kPiHere / 16)));

  const CombOptions comb;
  check_closed_model(generate_comb(comb));
  CHECK(area(generate_comb(comb)) == doctest::Approx(41 * 0.1 - 40 * 1e-3 * 0.9));
  CHECK(marker_counts(generate_comb(comb)) == std::map<std::int32_t, int>{{1, 44}, {2, 120}});

  HolesOptions holes;
  const Pslg plate = generate_holes(holes);
  check_closed_model(plate);
  CHECK(plate.holes.size() == 200);
  CHECK(area(plate) == doctest::Approx(200 - 200 * 6 * 0.09 * std::sin(kPiHere / 6)));
  holes.seed = 2;
  CHECK_FALSE(same(plate, generate_holes(holes)));
}

TEST_CASE("fan: the wedges have the angle, from the center and from a corner") {
  for (const bool corner : {false, true}) {
    const Pslg pslg = generate_fan({20, 2, corner});
    Pslg copy = pslg;
    CHECK(repair(copy).summary() == "");
    CHECK(marker_counts(pslg) == std::map<std::int32_t, int>{{1, 4}, {2, 21}});
    double last = 0;
    for (std::size_t i = 4; i < pslg.segments.size(); ++i) {
      const Point a = pslg.points[pslg.segments[i].a], b = pslg.points[pslg.segments[i].b];
      const double angle = std::atan2(b.y - a.y, b.x - a.x) * 180 / kPiHere;
      if (i > 4) CHECK(angle - last == doctest::Approx(2));
      last = angle;
    }
  }
}

TEST_CASE("random-polygon: one simple loop with the requested number of vertices, whatever the jitter") {
  for (const std::int32_t vertices : {4, 5, 6, 7, 8, 50, 51, 1002, 20003})
    for (const double jitter : {0.0, 0.3, 0.499}) {
      CAPTURE(vertices);
      CAPTURE(jitter);
      const Pslg pslg = generate_random_polygon({vertices, jitter, 5});
      check_closed_model(pslg);
      CHECK(pslg.points.size() == vertices);
      for (std::int32_t i = 0; i < vertices; ++i) REQUIRE(pslg.segments[i] == Pslg::Segment{i, (i + 1) % vertices, 1});
    }
}

TEST_CASE("random-points: as many points and segments as requested, none crossing") {
  for (const auto& [points, segments] :
       {std::pair{3, 0}, {4, 1}, {100, 25}, {1000, 250}, {20000, 1000}, {20000, 5000}}) {
    const RandomPointsOptions o{points, segments, 3};
    Pslg pslg = generate_random_points(o);
    CHECK(pslg.points.size() == points + 4);
    CHECK(pslg.segments.size() == segments + 4);
    CHECK(repair(pslg).summary() == "");
  }
}

TEST_CASE("bay: one coast with open sea, islands with their holes, about 10,000 points, in meters") {
  const Pslg bay = generate_bay({});
  check_closed_model(bay);
  CHECK(bay.points.size() > 8000);
  CHECK(bay.points.size() < 13000);
  CHECK(bay.holes.size() > 20);
  CHECK(marker_counts(bay).size() == bay.holes.size() + 2);
  CHECK(area(bay) > 0.1 * 60e3 * 90e3);
  CHECK(area(bay) < 0.7 * 60e3 * 90e3);
  for (std::uint64_t seed = 2; seed <= 8; ++seed)
    for (const double roughness : {0.0, 0.5, 1.0}) {
      CAPTURE(seed);
      CAPTURE(roughness);
      BayOptions o;
      o.seed = seed;
      o.roughness = roughness;
      o.resolution = 600;
      const Pslg other = generate_bay(o);
      check_closed_model(other);
      CHECK(same(other, generate_bay(o)));
    }
}

TEST_CASE("bay: the rivers of a seed are the same, in whichever order a compiler evaluates arguments") {
  const Pslg bay = generate_bay({.resolution = 400, .seed = 7});
  CHECK(bay.holes.size() == 7);
  CHECK(area(bay) == doctest::Approx(1.142031e9).epsilon(1e-3));
}

TEST_CASE("options out of range are named") {
  const auto refusal_of = [](const auto& make) { return error_text<InputError>(make); };
  CHECK(refusal_of([] { (void)generate_pipe({.channels = 20}); }) ==
        "generate pipe: the channels do not fit side by side; take fewer or narrower ones");
  CHECK(refusal_of([] { (void)generate_pipe({.edge = -1}); }) == "generate pipe: the edge length must be positive");
  CHECK(refusal_of([] { (void)generate_pipe({.outer_radius = std::nan("")}); }).starts_with("generate pipe: "));
  CHECK(
      refusal_of([] { (void)generate_pipe({.edge = 1e-300}); }).starts_with("generate: the edge length is too small"));
  CHECK(refusal_of([] { (void)generate_cylinder_flow({.radius = 40}); }).starts_with("generate cylinder-flow: "));
  CHECK(refusal_of([] { (void)generate_fan({.wedges = 400}); }).starts_with("generate fan: the wedges must span"));
  CHECK(refusal_of([] { (void)generate_comb({.width = 0.2}); }).starts_with("generate comb: the width"));
  CHECK(refusal_of([] { (void)generate_holes({.radius = 0.6}); }).starts_with("generate holes: "));
  CHECK(refusal_of([] { (void)generate_rectangle_hole({.sides = 2}); }).starts_with("generate rectangle-hole: "));
  CHECK(refusal_of([] { (void)generate_random_polygon({.vertices = 3}); }).starts_with("generate random-polygon: "));
  CHECK(refusal_of([] {
          (void)generate_random_points({.points = 100, .segments = 26});
        }).starts_with("generate random-"));
  CHECK(refusal_of([] { (void)generate_bay({.resolution = 0}); }).starts_with("generate bay: the resolution"));
}

TEST_CASE("bounds on a sum of noise from some of its octaves hold for all of it") {
  SeededRandom random(7);
  const GradientNoise noise(random);
  double widest = 0;
  int below = 0;
  for (int k = 0; k < 3000; ++k) {
    const Point p{random.uniform(-40, 40), random.uniform(-40, 40)};
    const int octaves = 1 + k % 9;
    const double gain = k % 2 == 0 ? 0.5 : 0.7, sum = noise.fractal(p, octaves, gain);
    for (int known = 0; known <= octaves; ++known) {
      const GradientNoise::Range range = noise.fractal_range(p, known, octaves, gain);
      CHECK(range.low <= sum);
      CHECK(sum <= range.high);
      if (known == octaves) CHECK(range.low == range.high);
    }
    widest = std::max(widest, std::fabs(noise(p)));
    const double bound = random.uniform(-1, 1);
    CHECK(noise.fractal_is_below(bound, p, octaves, gain) == (sum < bound));
    below += sum < bound ? 1 : 0;
  }
  CHECK(widest > 0.5);
  CHECK(below > 1000);
  CHECK(below < 2000);
}

TEST_CASE("what is refused before anything is made is what would be refused") {
  int refused = 0, valid = 0;
  const auto compare = [&](const std::string& name, const std::map<std::string, std::string>& parameters) {
    CAPTURE(name);
    const std::string before = error_text<InputError>([&] { require_generated(name, parameters); });
    CHECK(before == error_text<InputError>([&] { static_cast<void>(generate(name, parameters)); }));
    ++(before == "no error" ? valid : refused);
  };
  for (const std::string& name : generator_names()) {
    compare(name, {});
    compare(name, {{"nonsense", "1"}});
    for (const GeneratorParameter& parameter : generator_parameters(name))
      for (const char* const value : {"-1", "0", "0.3", "x"}) compare(name, {{parameter.name, value}});
  }
  compare("by", {});
  CHECK(refused > 100);
  CHECK(valid > 20);
}
