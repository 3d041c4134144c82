#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include "driftmesh/mesh.hpp"
#include "verify/findings.hpp"
#include "verify/words.hpp"

namespace driftmesh {

/// The edges between triangles of different subdomains, which count as constrained.
struct Interfaces {
  std::size_t edges = 0;          ///< those that are no subsegments
  std::size_t not_delaunay = 0;   ///< edges that are Delaunay only because they count as constrained
  std::size_t between_ranks = 0;  ///< edges whose subdomains have different ranks
  std::set<std::pair<std::int32_t, std::int32_t>> subdomains;  ///< the pairs of subdomains that meet

  void add(const Interfaces& others);
};

/// What edges must meet.
struct DelaunayRule {
  bool applies = true;
  double slack = 0;  ///< by how much a point may be inside a circumcircle; 0: the test is exact
};

/// Checks edges between two triangles that are no subsegments: those between subdomains are counted, all others must be
/// locally Delaunay.
class EdgeCheck {
 public:
  EdgeCheck(const NamedMesh& mesh, const DelaunayRule& delaunay, std::size_t max_listed)
      : names_(mesh), mesh_(mesh.mesh()), delaunay_(delaunay), findings_(max_listed) {}

  /// The triangle on one side of an edge and its corner opposite.
  struct Side {
    std::int32_t triangle = 0;
    std::int32_t apex = 0;
  };
  /// The edge from u to v.
  void check(std::int32_t u, std::int32_t v, const Side& left, const Side& right);
  /// Adds what was found at later edges.
  void append(const EdgeCheck& later);

  [[nodiscard]] const Findings& findings() const { return findings_; }
  [[nodiscard]] const Interfaces& interfaces() const { return interfaces_; }

 private:
  [[nodiscard]] bool is_interface(const Side& left, const Side& right) const {
    return !mesh_.subdomains.empty() && mesh_.subdomains[left.triangle] != mesh_.subdomains[right.triangle];
  }
  [[nodiscard]] bool is_delaunay(std::int32_t u, std::int32_t v, std::int32_t p, std::int32_t q) const;
  void note_interface(const Side& left, const Side& right, bool delaunay);
  void report(std::int32_t u, std::int32_t v, const Side& left, const Side& right);
  [[nodiscard]] const Point& at(std::int32_t point) const { return mesh_.points[point]; }

  NamedMesh names_;
  const Mesh& mesh_;
  DelaunayRule delaunay_;
  Findings findings_;
  Interfaces interfaces_;
};

}  // namespace driftmesh
