#pragma once

#include <memory>

#include "driftmesh/policy.hpp"
#include "driftmesh/policy_parameters.hpp"
#include "driftmesh/version.hpp"

namespace driftmesh::balancer {

/// What a shared library says of its policy, by the name driftmesh_policy.
struct PolicyEntry {
  const char* version;  ///< DRIFTMESH_VERSION of the headers: a program of another version refuses the library
  const char* name;
  std::unique_ptr<Policy> (*make)(Parameters& parameters);
};

}  // namespace driftmesh::balancer

/// Makes a shared library a policy for the program, which loads it where a policy is named by a file "pairs.so". Once
/// for each library, outside of all namespaces: DRIFTMESH_POLICY(pairs, my::make_pairs); The library does not link
/// driftmesh: the program that loads it has what these headers declare.
///
/// \code
/// #include "driftmesh/policy_library.hpp"
/// std::unique_ptr<driftmesh::balancer::Policy> make_still(driftmesh::balancer::Parameters&) {
///   struct Still final : driftmesh::balancer::Policy {
///     driftmesh::balancer::Placement placement() const override { return driftmesh::balancer::Placement::kNobody; }
///   };
///   return std::make_unique<Still>();
/// }
/// DRIFTMESH_POLICY(still, make_still);
/// \endcode
#define DRIFTMESH_POLICY(NAME, MAKE)                                                               \
  extern "C" {                                                                                     \
  [[gnu::visibility("default")]] extern const ::driftmesh::balancer::PolicyEntry driftmesh_policy; \
  const ::driftmesh::balancer::PolicyEntry driftmesh_policy{DRIFTMESH_VERSION, #NAME, MAKE};       \
  }                                                                                                \
  static_assert(true)
