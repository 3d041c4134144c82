#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "driftmesh/names.hpp"
#include "io/file_sink.hpp"

namespace driftmesh {

/// What comments of a text format say of its tags, integers that stand for markers and regions: which value each of
/// them is for, and what it is called. "# driftmesh region 1000001 -1.25 reef"
struct TagComments {
  std::map<std::int32_t, std::int32_t> markers;  ///< by tag
  std::map<std::int32_t, double> regions;        ///< by tag
  Names names;

  /// Takes in what is behind the '#' of a comment; those of other programs say nothing.
  void read(std::string_view comment);
  /// The value of a tag; of one without a comment the tag itself.
  [[nodiscard]] std::int32_t marker_of(std::int32_t tag) const;
  [[nodiscard]] double region_of(std::int32_t tag) const;
};

/// Writes a line for each region, and for each marker that is named or has another number as its tag.
void write_tag_comments(FileSink& sink, const std::map<double, std::int32_t>& marker_tags,
                        const std::map<double, std::int32_t>& region_tags, const Names& names);

}  // namespace driftmesh
