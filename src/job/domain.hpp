#pragma once

#include <memory>
#include <span>
#include <string>

#include "balancer/policy_list.hpp"
#include "decompose/decomposition.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/repair.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"
#include "sizing/make_size_field.hpp"

namespace driftmesh::job {

/// Data that a caller has in memory, which replaces what a request names. Null: none. Pointers are not owning.
struct Given {
  const Pslg* input = nullptr;                   ///< as the user provides it; it is repaired first
  const SizeField* size = nullptr;               ///< the same function on every rank
  const Decomposition* decomposition = nullptr;  ///< made from the same input, after repair
  balancer::PolicyMaker policies{};              ///< for load balancing; equal on every rank
};

/// The domain to be meshed.
struct Domain {
  Pslg pslg;  ///< repaired
  RepairReport repairs;
  std::unique_ptr<const SizeField> own_size;  ///< made for the request, or null
  const SizeField* size = nullptr;            ///< the one to use: own_size, a given one, or null
};

/// Reads or generates the domain, repairs it, applies the rule for holes, and makes the size field. Throws InputError,
/// FileError.
[[nodiscard]] Domain read_domain(const Request& request, const Given& given, Watch& watch);

/// Adds hole points to a repaired input where the rule makes holes of its rings.
void add_nested_holes(HoleRule rule, Pslg& pslg);

/// Passes on warnings about the input, only the first of them if there are very many. Throws InputError instead if the
/// request is strict.
void warn(const Request& request, std::span<const std::string> warnings, Watch& watch);

/// The request's settings for the sizes of triangles.
[[nodiscard]] SizingOptions sizing_of(const Request::Sizing& sizing);

/// The name of the domain: its file, the generated model, or "input" if a caller has it in memory.
[[nodiscard]] std::string input_name(const Request& request);

}  // namespace driftmesh::job
