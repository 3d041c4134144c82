#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "verify/subsegments.hpp"

namespace driftmesh {

/// The subsegments of a mesh joined end to end: a chain runs between two corners (points of the input) through vertices
/// that have exactly two subsegments, so it is what one input segment was split into.
class Chains {
 public:
  struct Chain {
    std::vector<std::int32_t> vertices;     ///< from end to end
    std::vector<std::int32_t> subsegments;  ///< subsegments[i] joins vertices[i] and vertices[i + 1]
  };

  /// Chains end at the points for which is_corner(v) holds and at all vertices that do not have exactly two
  /// subsegments. A loop without a corner is broken at one of its vertices.
  Chains(const Mesh& mesh, const Subsegments& subsegments, const std::function<bool(std::int32_t)>& is_corner);

  [[nodiscard]] const std::vector<Chain>& all() const { return chains_; }
  [[nodiscard]] const Subsegments& subsegments() const { return *subsegments_; }
  /// The chain that has `point` strictly between its ends, or kNone.
  [[nodiscard]] std::int32_t through(std::int32_t point) const { return through_[point]; }

 private:
  void follow(std::int32_t corner, std::int32_t subsegment);

  const Subsegments* subsegments_;
  std::vector<Chain> chains_;
  std::vector<std::int32_t> through_;
  std::vector<char> ends_chain_;  // per point
  std::vector<char> taken_;       // per subsegment
};

/// Whether a vertex does not have two subsegments, or they bend there by more than a millionth: a guess at the corners
/// of an input that is not given.
[[nodiscard]] bool bends_at(const Mesh& mesh, const Subsegments& subsegments, std::int32_t point);

}  // namespace driftmesh
