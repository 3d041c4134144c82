#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/same_input.hpp"
#include "decompose/same_segments.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/exceptions.hpp"
#include "oracles/meshing.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "support/made_mesh.hpp"
#include "support/prepared_mesh.hpp"
#include "support/random_domain.hpp"
#include "support/refine_together.hpp"

// Decompositions of random domains: invariants, and refinement of the subdomains.

using namespace driftmesh;
using namespace driftmesh::oracles;
using testing::prepared;

namespace {

struct Outcome {
  std::string problem;  ///< empty if all is well
  bool refused = false;
  DecompositionReport report;
};

double total_area(const Triangulation& mesh) {
  return summarize_angles(mesh).total_area;
}

/// A message about the first subdomain whose triangulation does not match the decomposition.
std::string check_triangulations(const Decomposition& d) {
  double whole = 0;
  for (const auto& s : d.subdomains) whole += s.area;
  for (const SubdomainId i : ids_of(d.subdomains)) {
    const SubdomainMesh part = subdomain_triangulation(d, i);
    if (!(std::fabs(total_area(part.mesh) - d.subdomains[i].area) <= 1e-9 * whole))
      return "subdomain " + to_string(i) + " is triangulated to area " + std::to_string(total_area(part.mesh)) +
             " instead of " + std::to_string(d.subdomains[i].area);
  }
  return "";
}

Outcome decompose_and_check(const Pslg& input, const Triangulation& mesh, int n) {
  Outcome outcome;
  DecomposeOptions options;
  options.subdomains = n;
  try {
    const Decomposition d = decompose(mesh, options);
    outcome.report = check_decomposition(d);
    require_same_input(d, input, "the decomposition");
    require_same_segments(d, mesh, "the decomposition");
    if (d.size() != static_cast<std::size_t>(n)) outcome.problem = std::to_string(d.size()) + " subdomains";
    if (!outcome.report.valid()) outcome.problem = outcome.report.problems[0];
    if (outcome.problem.empty() && !(std::fabs(outcome.report.area / total_area(mesh) - 1) < 1e-9))
      outcome.problem = "the areas do not sum to the domain's";
    if (outcome.problem.empty()) outcome.problem = check_triangulations(d);
  } catch (const Error& error) {
    outcome.refused = true;
    outcome.problem = error.what();
  }
  return outcome;
}

/// Random domains beside each other, some a thousand times as large as others, and a chain of squares that touch at
/// their corners.
struct Archipelago {
  Pslg input;
  int islands = 0;
};

Archipelago make_archipelago(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Archipelago result;
  double offset = 0;
  for (const int random_islands = static_cast<int>(random() % 6); result.islands < random_islands; ++result.islands) {
    RandomPslgShape shape = make_random_shape(random());
    shape.scale = std::pow(10, 1.5 * unit(random));
    shape.offset = offset += 4 * shape.scale;
    offset += 4 * shape.scale;
    testing::append(result.input, make_random_pslg(random(), shape).input);
  }
  const auto chain = static_cast<std::int32_t>(1 + random() % 12);
  result.islands += chain;
  const auto first = static_cast<std::int32_t>(result.input.points.size());
  const double x = -10, width = 0.1 + unit(random);
  for (std::int32_t i = 0; i <= chain; ++i) result.input.points.push_back({x - i * width, x - i * width});
  for (std::int32_t i = 0; i < chain; ++i) {
    const auto corner = static_cast<std::int32_t>(result.input.points.size());
    result.input.points.push_back({x - i * width, x - (i + 1) * width});
    result.input.points.push_back({x - (i + 1) * width, x - i * width});
    const std::int32_t ring[] = {first + i, corner + 1, first + i + 1, corner};
    for (int k = 0; k < 4; ++k) result.input.segments.push_back({ring[k], ring[(k + 1) % 4], 1});
  }
  return result;
}

/// A square with holes that are regular polygons: no corner of the domain is sharper than 90 degrees.
Pslg square_with_holes(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Pslg pslg;
  const auto add_ring = [&](const Point& center, double radius, double turn, std::int32_t corners) {
    const auto first = static_cast<std::int32_t>(pslg.points.size());
    for (std::int32_t i = 0; i < corners; ++i) {
      const double angle = turn + 2 * std::numbers::pi * i / corners;
      pslg.points.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
      pslg.segments.push_back({first + i, first + (i + 1) % corners, 1});
    }
  };
  add_ring({0, 0}, 3, std::numbers::pi / 4, 4);
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      if (random() % 4 == 0) continue;
      const Point center{x + 0.3 * unit(random), y + 0.3 * unit(random)};
      add_ring(center, 0.05 + 0.5 * unit(random), 6 * unit(random), static_cast<std::int32_t>(3 + random() % 6));
      pslg.holes.push_back(center);
    }
  return pslg;
}

/// What the theorem of docs/theory.md says of a decomposition for one angle bound, without a bound on area.
struct Distances {
  double subsegment = 0;  ///< the shortest, at least
  double vertices = 0;    ///< least distance between vertices that see each other
  bool holds = false;
};

double distance_to(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(a.x + t * dx - p.x, a.y + t * dy - p.y);
}

Distances distances_of(const Decomposition& d, double min_angle) {
  double feature = std::numeric_limits<double>::infinity(), cosine = 0;
  const auto at = [&](GlobalPointId v) { return d.points[v]; };
  for (const Decomposition::Root& r : d.roots) {
    for (const GlobalPointId v : ids_of(d.points))
      if (v != r.a && v != r.b) feature = std::min(feature, distance_to(at(v), at(r.a), at(r.b)));
    for (const Decomposition::Root& s : d.roots)
      for (const auto& [apex, one] : {std::pair(r.a, r.b), std::pair(r.b, r.a)})
        for (const auto& [other_apex, other] : {std::pair(s.a, s.b), std::pair(s.b, s.a)}) {
          if (apex != other_apex || one == other) continue;
          const double ux = at(one).x - at(apex).x, uy = at(one).y - at(apex).y;
          const double vx = at(other).x - at(apex).x, vy = at(other).y - at(apex).y;
          cosine = std::max(cosine, (ux * vx + uy * vy) / std::hypot(ux, uy) / std::hypot(vx, vy));
        }
  }
  const double c = cosine > 0.5 ? 1 / (2 * cosine) : 1, ratio = 1 / (2 * std::sin(min_angle * std::numbers::pi / 180));
  const double length = std::sqrt(0.75) * feature;
  return {length, c * length, std::sqrt(0.75) * ratio * c >= 1};
}

}  // namespace

TEST_CASE("no two vertices come nearer to each other than the theorem says") {
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t exchanged = 0, subsegments = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(testing::case_count(60)); ++seed) {
    CAPTURE(seed);
    const Triangulation mesh = prepared(square_with_holes(seed));
    DecomposeOptions options;
    options.subdomains = static_cast<std::int32_t>(2 + seed % 19);
    const Decomposition d = decompose(mesh, options);
    QualityBounds bounds;
    bounds.min_angle = seed % 2 == 0 ? 20 : 25;
    const Distances least = distances_of(d, bounds.min_angle);
    REQUIRE(least.holds);
    const auto refined = testing::refine_together(d, bounds);
    exchanged += refined.exchanged;
    for (const SubdomainMesh& part : refined.parts) {
      const auto length = [&](VertexId u, VertexId v) {
        return std::hypot(part.mesh.points[u].x - part.mesh.points[v].x, part.mesh.points[u].y - part.mesh.points[v].y);
      };
      for (const Subsegment& s : part.mesh.subsegments) {
        if (!s.is_leaf()) continue;
        REQUIRE(length(s.vertex[0], s.vertex[1]) >= least.subsegment * (1 - 1e-9));
        ++subsegments;
      }
      for (const Triangle& t : part.mesh.triangles)  // the nearest two that see each other are joined
        for (std::size_t i = 0; i < 3 && t.alive(); ++i) {
          const double edge = length(t.vertex[i], t.vertex[(i + 1) % 3]);
          REQUIRE(edge >= least.vertices * (1 - 1e-9));
          const bool added = !part.points.has(t.vertex[i]) || !part.points.has(t.vertex[(i + 1) % 3]);
          if (added) nearest = std::min(nearest, edge / least.vertices);
        }
    }
  }
  MESSAGE(subsegments << " subsegments, " << exchanged << " split points exchanged; an added vertex is at " << nearest
                      << " times the distance from another one");
  CHECK(exchanged > 0);
  CHECK(nearest < 2);  // else the bound would mean little
}

TEST_CASE("grids of points without segments are cut into any number of subdomains") {
  std::mt19937_64 random = testing::seeded_generator("grids of points");
  std::size_t inner = 0;
  for (std::int64_t i = 0; i < testing::case_count(60); ++i) {
    const std::uint64_t seed = random();
    CAPTURE(seed);
    std::mt19937_64 drawn(seed);
    // Turned, and rounded to some decimals, so that rows are only nearly straight: bridges run along them.
    const auto columns = static_cast<int>(3 + drawn() % 22), rows = static_cast<int>(3 + drawn() % 22);
    const double width = 10, height = static_cast<double>(3 + drawn() % 8), angle = static_cast<double>(drawn() % 90);
    const double cosine = std::cos(angle * std::numbers::pi / 180), sine = std::sin(angle * std::numbers::pi / 180);
    const double unit = std::pow(10, static_cast<double>(drawn() % 9));
    Pslg grid;
    for (int x = 0; x < columns; ++x)
      for (int y = 0; y < rows; ++y)
        grid.points.push_back({std::round(unit * (x * width * cosine - y * height * sine)) / unit,
                               std::round(unit * (x * width * sine + y * height * cosine)) / unit});
    repair(grid);
    CAPTURE(poly_text(grid));
    const Triangulation mesh = prepared(grid);
    for (const int n : {2, 5, 16, 60}) {
      CAPTURE(n);
      const Outcome outcome = decompose_and_check(grid, mesh, n);
      CHECK(outcome.problem == "");
    }
    inner += grid.points.size();
  }
  CHECK(inner > 0);
}

TEST_CASE("domains of many parts are cut into any number of subdomains") {
  std::size_t shared = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(testing::case_count(100)); ++seed) {
    CAPTURE(seed);
    const Archipelago domain = make_archipelago(seed);
    CAPTURE(poly_text(domain.input));
    const Triangulation mesh = prepared(domain.input);
    for (const int n : {1, 2, 3, domain.islands - 1, domain.islands, domain.islands + 7, 40}) {
      if (n < 1) continue;
      CAPTURE(n);
      const Outcome outcome = decompose_and_check(domain.input, mesh, n);
      CHECK(outcome.problem == "");
      shared += n < domain.islands;
    }
  }
  CHECK(shared > 0);
}

TEST_CASE("parts that share a subdomain share its work evenly") {
  Pslg squares;
  for (int i = 0; i < 400; ++i) {
    const double x = 2 * (i % 20), y = 2 * (i / 20);
    Pslg square;
    square.points = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
    for (std::int32_t k = 0; k < 4; ++k) square.segments.push_back({k, (k + 1) % 4, 1});
    append(squares, square);
  }
  const Triangulation mesh = prepared(squares);
  for (const int n : {2, 7, 40}) CHECK(decompose_and_check(squares, mesh, n).report.largest_load < 1.11);
  Pslg continent = squares;  // should get nine of ten subdomains
  Pslg land;
  land.points = {{100, 0}, {160, 0}, {160, 60}, {100, 60}};
  for (std::int32_t k = 0; k < 4; ++k) land.segments.push_back({k, (k + 1) % 4, 1});
  append(continent, land);
  for (const int n : {2, 10, 40}) {
    CAPTURE(n);
    const Outcome outcome = decompose_and_check(continent, prepared(continent), n);
    CHECK(outcome.problem == "");
    CHECK(outcome.report.largest_load < (n == 2 ? 1.81 : 1.5));
  }
}

TEST_CASE("random domains are cut into any number of subdomains") {
  std::size_t cut = 0, steep = 0, uneven = 0;
  double worst_load = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(testing::case_count(150)); ++seed) {
    CAPTURE(seed);
    RandomPslgShape shape = make_random_shape(seed);
    const RandomPslg random = make_random_pslg(seed, shape);
    CAPTURE(poly_text(random.input));
    const Triangulation mesh = prepared(random.input);
    std::mt19937_64 numbers(seed);
    for (const int n : {1, 2, static_cast<int>(2 + numbers() % 30), static_cast<int>(1 + numbers() % 200)}) {
      CAPTURE(n);
      const Outcome outcome = decompose_and_check(random.input, mesh, n);
      CHECK(outcome.problem == "");
      ++cut;
      steep += outcome.report.smallest_angle >= 54;
      worst_load = std::max(worst_load, outcome.report.largest_load);
      uneven += outcome.report.largest_load > 1.5;
    }
  }
  MESSAGE(cut << " decompositions, " << steep << " with angles of 54 degrees and more; " << uneven
              << " with loads above 1.5, at most " << worst_load);
  CHECK(500 * (cut - steep) <= cut);  // in these, wider angles would leave a separator beside a wall
  CHECK(100 * uneven < 10 * cut);
}

TEST_CASE("generated inputs: combs, fans and plates with many holes") {
  const std::pair<std::string, Pslg> inputs[] = {
      {"comb", generate_comb({})},   {"fan", generate_fan({})},   {"corner fan", generate_fan({30, 1, true})},
      {"holes", generate_holes({})}, {"pipe", generate_pipe({})}, {"flow", generate_cylinder_flow({})}};
  for (const auto& [name, pslg] : inputs) {
    CAPTURE(name);
    const Triangulation mesh = prepared(pslg);
    for (const int n : {2, 7, 30, 200, 1000}) {
      CAPTURE(n);
      const Outcome outcome = decompose_and_check(pslg, mesh, n);
      CHECK(outcome.problem == "");
      CHECK(outcome.report.smallest_angle >= 54);
      CHECK(outcome.report.largest_load <= 1.55);
      MESSAGE(name << " " << n << ": angle " << outcome.report.smallest_angle << ", load "
                   << outcome.report.largest_load << ", separators "
                   << outcome.report.separator_length /
                          (2.06 * std::sqrt(outcome.report.area * n) - outcome.report.border_length / 2));
    }
  }
}

TEST_CASE("separators find their way among hundreds of segments that touch nothing") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CAPTURE(seed);
    const Pslg pslg = generate_random_points({.points = 20000, .segments = 400, .seed = seed});
    const Triangulation mesh = prepared(pslg);
    for (const int n : {2, 30}) {
      CAPTURE(n);
      const Outcome outcome = decompose_and_check(pslg, mesh, n);
      CHECK(outcome.problem == "");
      CHECK(outcome.report.largest_load <= 1.7);
    }
  }
}

TEST_CASE("random domains, refined apart, conform after exchanging split points") {
  std::size_t exchanged = 0, triangles = 0;
  const auto cases = static_cast<std::uint64_t>(testing::case_count(60));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const RandomPslg random = make_random_pslg(seed, make_random_shape(seed));
    CAPTURE(poly_text(random.input));
    const Triangulation mesh = prepared(random.input);
    DecomposeOptions options;
    options.subdomains = static_cast<std::int32_t>(2 + seed % 9);
    const Decomposition d = decompose(mesh, options);
    QualityBounds bounds;
    bounds.min_angle = seed % 2 == 0 ? 20 : 25;
    bounds.plain.area = total_area(mesh) / 300;
    const auto refined = testing::refine_together(d, bounds);
    CHECK(refined.not_conforming.empty());
    CHECK(refined.refused == 0);
    double area = 0;
    for (const SubdomainMesh& part : refined.parts) {
      const Exceptions exceptions = find_exceptions(part.mesh, bounds);
      CHECK(exceptions.large.empty());
      for (const Exceptions::Item& item : exceptions.skinny)
        CHECK((item.cause == ExceptionCause::kInputAngle || item.cause == ExceptionCause::kShell));
      area += total_area(part.mesh);
      triangles += part.mesh.live_triangles();
    }
    CHECK(area == doctest::Approx(total_area(mesh)).epsilon(1e-9));
    exchanged += refined.exchanged;
  }
  MESSAGE(triangles << " triangles, " << exchanged << " split points exchanged");
  CHECK(exchanged > 2 * cases);  // else nothing was tested
}

TEST_CASE("narrow corners take as few triangles in subdomains as in one piece") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t whole = 0, cut = 0;
  for (std::int64_t i = 0; i < testing::case_count(60); ++i) {
    // Two segments from the middle of a square, at an angle from 1e-5 to 0.01, their ends in any order.
    const double angle = std::pow(10, -5 + 3 * unit(random)), turn = 6.28 * unit(random);
    const double first = 0.1 + 0.3 * unit(random), second = 0.1 + 0.3 * unit(random);
    const Point points[] = {{0, 0},
                            {1, 0},
                            {1, 1},
                            {0, 1},
                            {0.5, 0.5},
                            {0.5 + first * std::cos(turn), 0.5 + first * std::sin(turn)},
                            {0.5 + second * std::cos(turn + angle), 0.5 + second * std::sin(turn + angle)}};
    std::vector<std::int32_t> place{0, 1, 2, 3, 4, 5, 6};
    std::shuffle(place.begin(), place.end(), random);
    Pslg input;
    input.points.resize(place.size());
    for (std::size_t k = 0; k < place.size(); ++k) input.points[place[k]] = points[k];
    for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {2, 3}, {3, 0}, {4, 5}, {4, 6}})
      input.segments.push_back({place[a], place[b], 1});
    CAPTURE(poly_text(input));
    const std::size_t in_one_piece = testing::made(input, testing::bounded(20, 0, 100000)).mesh.triangles.size();
    DecomposeOptions options;
    options.subdomains = static_cast<std::int32_t>(1 + i % 3);
    std::size_t in_subdomains = 0;
    for (const SubdomainMesh& part :
         testing::refine_together(decompose(prepared(input), options), {.min_angle = 20, .region_max_area = {}}).parts)
      in_subdomains += part.mesh.live_triangles();
    CHECK(in_subdomains < 1.5 * static_cast<double>(in_one_piece) + 50);
    whole += in_one_piece;
    cut += in_subdomains;
  }
  MESSAGE(whole << " triangles in one piece, " << cut << " in subdomains");
  CHECK(cut < 1.2 * static_cast<double>(whole));
}
