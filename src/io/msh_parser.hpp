#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// What the sections of a .msh file hold, before tags become indices.
struct RawMsh {
  using EntityKey = std::pair<std::int32_t, std::int32_t>;  ///< dimension and tag
  template <std::size_t kCorners>
  struct Elements {
    std::vector<std::uint64_t> tags;
    std::vector<std::array<std::uint64_t, kCorners>> nodes;
    std::vector<std::int32_t> entities;
  };
  struct Attribute {
    std::string name;  ///< empty: none
    std::vector<std::int32_t> nodes;
    std::vector<double> values;
    bool is_other = false;  ///< not by write_msh
  };
  template <class Value>
  struct AtElement {
    std::int32_t element = 0;
    Value value{};
  };
  struct ElementView {  ///< not by write_msh, or of data that it was given
    std::string name;
    std::vector<AtElement<double>> values;
  };
  struct Marker {
    std::uint64_t node = 0;
    std::int32_t marker = 0;
  };

  std::map<EntityKey, std::string> group_names;    ///< names of physical groups
  std::map<EntityKey, std::int32_t> entity_group;  ///< the first physical group of an entity
  std::vector<std::uint64_t> node_tags;
  std::vector<Point> nodes;
  Elements<2> lines;
  Elements<3> triangles;
  std::vector<std::uint64_t> point_elements;  ///< only their tags
  std::vector<Attribute> attributes;
  std::vector<AtElement<std::int32_t>> subdomains;
  std::vector<AtElement<std::int32_t>> ranks;
  std::vector<ElementView> views;  ///< if they are wanted
  std::optional<std::vector<Marker>> point_markers;
  std::string coordinates;                   ///< see Mesh
  std::map<EntityKey, double> group_values;  ///< markers and regions that neither name nor tag of the group says
};

/// Reads the sections of a file of format 4.1, ASCII or binary. Tags are not checked for existence. `views`: whether
/// those on elements are wanted. Errors: InputError.
[[nodiscard]] RawMsh parse_msh_sections(const std::string& path, std::string_view bytes, bool views = false);

}  // namespace driftmesh
