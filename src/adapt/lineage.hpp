#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "adapt/descent.hpp"
#include "adapt/generation.hpp"

namespace driftmesh::adapt {

/// What one generation has from the one before. Both outlive the object.
class Lineage {
 public:
  Lineage(const Generation& before, const Generation& after, std::int32_t threads);

  /// A point of the new mesh as a convex combination of points of the old one.
  struct Source {
    std::array<std::int32_t, 3> point{};
    std::array<double, 3> weight{};
    bool stays = false;  ///< it is the first of them
  };
  /// Calls visit(point, source) for each point of the new mesh, for several at once. That a border divides two
  /// subdomains does not matter: a point on it is one of the subdomain with the lower number.
  void visit_points(const std::function<void(std::int32_t, const Source&)>& visit) const;

  /// For each point, or triangle, of the new mesh its number in the old one; -1: it is not there.
  [[nodiscard]] std::vector<std::int32_t> stayed_points() const;
  [[nodiscard]] std::vector<std::int32_t> stayed_triangles() const;

 private:
  [[nodiscard]] bool is_the_same(SubdomainId s) const { return before_.parts[s].mesh == after_.parts[s].mesh; }
  void for_each_part(const std::function<void(SubdomainId)>& work) const;

  const Generation& before_;
  const Generation& after_;
  std::int32_t threads_;
  IdVector<SubdomainId, Descent> descents_;  // empty where the part is the same
  std::vector<SubdomainId> owner_;           // of each new point
};

}  // namespace driftmesh::adapt
