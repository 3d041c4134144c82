#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/ids.hpp"
#include "driftmesh/point.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A point of a Decomposition: the same on every rank.
enum class GlobalPointId : std::int32_t {};
inline constexpr GlobalPointId kNoPoint{-1};

[[nodiscard]] inline std::string to_string(GlobalPointId point) {
  return std::to_string(to_int(point));
}

/// A domain cut into subdomains. Plain data in flat arrays, which can be mapped to ranks, saved and loaded.
///
/// Invariants (check_decomposition tests them): subdomains cover the domain without overlap; each is connected, or
/// consists of whole parts of the domain, so that it has no interface; their borders consist of roots only; a root has
/// one or two sides in the domain; roots meet only at their ends. An input segment is a root, or a chain of roots where
/// separators end on it.
struct Decomposition {
  /// A segment that refinement cuts only at dyadic points, which are the same on both sides.
  struct Root {
    GlobalPointId a{};  ///< a -> b is the root's direction: a < b, or for a shell piece, away from its apex
    GlobalPointId b{};
    std::int32_t marker = 0;          ///< the input segment's; 0 for separators
    std::int32_t shell = kNone;       ///< the shell that the piece belongs to (see mesh/corners.hpp)
    SubdomainId left = kNoSubdomain;  ///< subdomain left of a -> b; kNoSubdomain: not in the domain
    SubdomainId right = kNoSubdomain;
    std::uint16_t left_region = 0;  ///< label of the region on that side (see mesh/cdt.hpp), 0 without a side
    std::uint16_t right_region = 0;
    bool separator = false;  ///< made by the decomposition, not part of a segment of the input
    /// Whether it is shared by two subdomains.
    [[nodiscard]] bool is_interface() const { return left != kNoSubdomain && right != kNoSubdomain && left != right; }
    /// The subdomain on the other side of an interface.
    [[nodiscard]] SubdomainId across_from(SubdomainId one) const { return left == one ? right : left; }
    /// Gives it the other direction.
    void turn_around() {
      std::swap(a, b);
      std::swap(left, right);
      std::swap(left_region, right_region);
    }
    friend bool operator==(const Root&, const Root&) = default;
  };
  struct Subdomain {
    double area = 0;
    double predicted = 0;  ///< triangles after refinement
    Point centroid;
    std::uint16_t region = 0;  ///< the region label of the largest part of its area
    friend bool operator==(const Subdomain&, const Subdomain&) = default;
  };

  IdVector<GlobalPointId, Point> points;
  /// For each point the index of an input point, a shell end (see handles.hpp), or kNone for a separator's end.
  IdVector<GlobalPointId, VertexOrigin> origin;
  IdVector<GlobalRootId, Root> roots;
  IdVector<SubdomainId, Subdomain> subdomains;
  /// Roots of subdomain i, ascending: root_list[root_begin[i]] up to root_begin[i + 1]. A root inside the subdomain (on
  /// both sides) is listed once.
  std::vector<std::int32_t> root_begin{0};
  std::vector<GlobalRootId> root_list;
  /// Likewise, the points inside subdomain i that are on no root (isolated input points).
  std::vector<std::int32_t> point_begin{0};
  std::vector<GlobalPointId> point_list;

  [[nodiscard]] std::size_t size() const { return subdomains.size(); }
  [[nodiscard]] std::span<const GlobalRootId> roots_of(SubdomainId i) const { return slice(root_begin, root_list, i); }
  [[nodiscard]] std::span<const GlobalPointId> inner_points_of(SubdomainId i) const {
    return slice(point_begin, point_list, i);
  }
  friend bool operator==(const Decomposition&, const Decomposition&) = default;

 private:
  template <class T>
  static std::span<const T> slice(const std::vector<std::int32_t>& begin, const std::vector<T>& list, SubdomainId i) {
    return {list.data() + begin[to_index(i)], list.data() + begin[to_index(i) + 1]};
  }
};

/// Sets root_begin and root_list from the sides of the roots.
void list_roots(Decomposition& decomposition);
/// Sets point_begin and point_list from the points inside subdomains, in any order.
void list_inner_points(Decomposition& decomposition, std::vector<std::pair<SubdomainId, GlobalPointId>> inner);

/// Two subdomains with common roots.
struct Interface {
  SubdomainId first;  ///< first < second
  SubdomainId second;
  double length;  ///< all roots they share, together
};

/// Each pair of subdomains with a common root once, in ascending order.
[[nodiscard]] std::vector<Interface> interfaces(const Decomposition& decomposition);

}  // namespace driftmesh
