#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "io/boundary_strings.hpp"

namespace driftmesh {

// What ADCIRC and SCHISM call the type of a boundary is the name of a marker in a Mesh: "open", or "ibtype 52" with
// ADCIRC's number (IBTYPE), behind which more words may follow. Boundaries of one type that follow each other have
// markers of their own: "open", "open 2". All files that have names keep them. The heights and coefficients of weirs
// are in Mesh::weirs.

inline constexpr std::int32_t kLargestType = 999;

/// The columns behind a node of a weir.
struct WeirColumns {
  bool has_pairs = false;   ///< the node on the other side comes first
  std::size_t numbers = 0;  ///< heights, coefficients and sizes
};
/// None: the type is not that of a weir.
[[nodiscard]] std::optional<WeirColumns> weir_columns(std::int32_t type);

[[nodiscard]] std::string name_of_type(std::int32_t type);
/// None: the name says nothing of a type.
[[nodiscard]] std::optional<std::int32_t> type_named(std::string_view name);

/// Which type each edge of the boundary has in a file.
class EdgeTypes {
 public:
  /// Edges with one of the markers `open` are open, or without any those whose marker is called so. `with_weirs`: those
  /// of mesh.weirs, both sides and the ends between them, are kWeirType.
  EdgeTypes(const Mesh& mesh, std::span<const std::int32_t> open, bool with_weirs);

  static constexpr std::int32_t kWeirType = -2;

  [[nodiscard]] EdgeType of(std::int32_t from, std::int32_t to, std::int32_t edge) const;

 private:
  const Mesh& mesh_;
  std::map<std::int32_t, EdgeType> by_marker_;
  std::vector<std::array<std::int32_t, 2>> weirs_;  // edges from low to high vertex, ascending
};

/// How many strings of each type a mesh has by the names of its markers and by its weirs; without mainland and islands,
/// which need no names.
[[nodiscard]] std::map<std::int32_t, std::size_t> count_types(const Mesh& mesh);

/// "open (1 string), ibtype 24 (2 strings)"
[[nodiscard]] std::string list_of_types(const std::map<std::int32_t, std::size_t>& counts);

}  // namespace driftmesh
