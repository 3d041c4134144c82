#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>

#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/same_input.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/exceptions.hpp"
#include "oracles/meshing.hpp"
#include "oracles/random_pslg.hpp"
#include "property/cases.hpp"
#include "support/refine_together.hpp"

// Random domains through decomposition: the invariants, and what refinement makes of the subdomains.

using namespace driftmesh;
using namespace driftmesh::oracles;

namespace {

struct Outcome {
  std::string problem;  ///< empty if all is well
  bool refused = false;
  DecompositionReport report;
};

double total_area(const Triangulation& mesh) {
  return summarize_angles(mesh).total_area;
}

/// The first subdomain whose triangulation is not what the decomposition says, in words.
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

Triangulation prepared(const Pslg& pslg) {
  Triangulation mesh = triangulate(pslg);
  prepare_corners(mesh);
  return mesh;
}

}  // namespace

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
  CHECK(steep == cut);
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
    bounds.max_area = total_area(mesh) / 300;
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
