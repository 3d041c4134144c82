#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>

#include "driftmesh/repair.hpp"
#include "job/domain.hpp"
#include "property/cases.hpp"
#include "support/made_mesh.hpp"
#include "support/random.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// Each kind of bound on sizes, all the way from a request: refinement, forecasts, cuts and interfaces obey it, and the
// verifier judges by it. A new kind is one more row.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A rectangle of 2 x 1 in two halves, which are regions, with a round hole in one of them.
Pslg halves() {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 1}, {4, 5, 1}, {5, 0, 1}, {1, 4, 2}};
  for (int i = 0; i < 20; ++i) {
    const double angle = 2 * std::numbers::pi * i / 20;
    pslg.points.push_back({1.5 + 0.2 * std::cos(angle), 0.5 + 0.2 * std::sin(angle)});
    pslg.segments.push_back({6 + i, 6 + (i + 1) % 20, 3});
  }
  pslg.holes = {{1.5, 0.5}};
  pslg.regions = {{{0.1, 0.1}, 1, 0}, {{1.1, 0.1}, 2, 0}};
  return pslg;
}

/// Asks for some thousands of triangles at most.
struct Kind {
  const char* name;
  void (*ask)(Random&, job::Request&, Pslg&);
};

constexpr Kind kKinds[] = {
    {"area", [](Random& random, job::Request& r, Pslg&) { r.bounds.area = std::exp2(uniform(random, -12, -9)); }},
    {"areas of regions",
     [](Random& random, job::Request&, Pslg& pslg) {
       pslg.regions[0].max_area = std::exp2(uniform(random, -12, -8));
       pslg.regions[1].max_area = std::exp2(uniform(random, -12, -8));
     }},
    {"sizes by place",
     [](Random& random, job::Request& r, Pslg&) {
       const auto number = [&](double low, double high) { return std::to_string(uniform(random, low, high)); };
       r.sizing.expression =
           number(0.02, 0.06) + "+" + number(0.05, 0.3) + "*hypot(x-" + number(0, 2) + ",y-" + number(0, 1) + ")";
     }},
};

/// What the verifier says of a mesh by the bounds of the request, in words; empty if it accepts the mesh.
std::string verdict(const Mesh& mesh, const Pslg& pslg, const job::Request& request) {
  const SizeSource size = job::size_of(request.sizing, {}, nullptr, pslg);
  VerifyOptions options{.min_angle = request.bounds.angle, .plain = request.bounds, .size = size.field.get()};
  options.size_is_compiled = true;
  const VerifyReport report = verify(mesh, pslg, options);
  return report.accepted() ? "" : report_text(report, options);
}

}  // namespace

TEST_CASE("every kind of bound holds in one piece and in subdomains, alone and with others, and is forecast") {
  Random random = seeded_generator("kinds of bounds");
  for (std::int64_t i = 0; i < case_count(24); ++i) {
    Pslg pslg = halves();
    job::Request request;
    std::string names;
    const std::size_t kinds = std::size(kKinds), chosen = static_cast<std::size_t>(i) % kinds;
    for (std::size_t k = 0; k < kinds; ++k) {
      if (k != chosen && random() % 4 != 0) continue;
      names += std::string(names.empty() ? "" : ", ") + kKinds[k].name;
      kKinds[k].ask(random, request, pslg);
    }
    CAPTURE(names);
    CAPTURE(i);
    for (const std::int32_t subdomains : {1, 7}) {
      CAPTURE(subdomains);
      request.decomposition.subdomains = subdomains;
      const auto& [mesh, record, decomposition] = made(pslg, request);
      CHECK(verdict(mesh, pslg, request) == "");
      CHECK(record.exceptions.empty());
      CHECK(record.forecast / static_cast<double>(record.triangles) > 0.7);
      CHECK(record.forecast / static_cast<double>(record.triangles) < 1.4);
      double loads = 0, most = 0;
      for (const Decomposition::Subdomain& s : decomposition.subdomains) {
        loads += s.predicted;
        most = std::max(most, s.predicted);
      }
      CHECK(most <= 2.5 * loads / subdomains);  // the work was where it was forecast
    }
  }
}

TEST_CASE("the verifier finds what misses a bound of each kind") {
  Random random = seeded_generator("bounds that are missed");
  for (const Kind& kind : kKinds) {
    CAPTURE(std::string(kind.name));
    const Pslg unbounded = halves();
    const Made coarse = made(unbounded, job::Request{});
    CHECK(verdict(coarse.mesh, unbounded, job::Request{}) == "");
    Pslg pslg = unbounded;
    job::Request request;
    kind.ask(random, request, pslg);
    CHECK(verdict(coarse.mesh, pslg, request) != "");
    CHECK(made(pslg, request).record.triangles > 2 * coarse.record.triangles);
  }
}
