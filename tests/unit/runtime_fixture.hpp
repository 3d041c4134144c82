#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "mesh/digest.hpp"
#include "mesh/exceptions.hpp"
#include "support/plans.hpp"
#include "support/simulated_run.hpp"

namespace driftmesh::testing {

/// An L with a square hole.
inline Pslg ell() {
  Pslg pslg;
  pslg.points = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0.3, 0.3}, {0.6, 0.3}, {0.6, 0.6}, {0.3, 0.6}};
  for (std::int32_t i = 0; i < 6; ++i) pslg.segments.push_back({i, (i + 1) % 6, 1});
  for (std::int32_t i = 0; i < 4; ++i) pslg.segments.push_back({6 + i, 6 + (i + 1) % 4, 2});
  pslg.holes = {{0.45, 0.45}};
  return pslg;
}

/// A plan with short slices, so that even small subdomains take several.
inline RunPlan plan_of(const Pslg& pslg, const QualityBounds& bounds, std::int32_t ranks, std::int32_t subdomains,
                       Presplit presplit) {
  RunPlan plan = plan_for(pslg, bounds, ranks, subdomains, presplit);
  plan.work.slice = 50;
  return plan;
}

/// The digest of the whole mesh.
inline std::uint64_t digest_of(const std::vector<const Subdomain*>& subdomains) {
  std::uint64_t sum = 0;
  for (const Subdomain* s : subdomains) sum += mesh_digest(s->mesh().mesh);
  return sum;
}

/// Checks that the subdomains conform and meet the bounds of the plan.
inline void check_mesh(const RunPlan& plan, const std::vector<const Subdomain*>& subdomains) {
  const auto problems = conformity_problems(plan.decomposition, subdomains);
  CHECK_MESSAGE(problems.empty(), (problems.empty() ? "" : problems[0]));
  for (const Subdomain* s : subdomains) {
    const Exceptions exceptions = find_exceptions(s->mesh().mesh, plan.bounds);
    CHECK(exceptions.large.empty());
    CHECK(exceptions.skinny.empty());
  }
}

}  // namespace driftmesh::testing
