#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "driftmesh/names.hpp"

namespace driftmesh {

/// What is wrong with a text as a name, as the end of a sentence that begins with it; empty: nothing (see Names).
[[nodiscard]] std::string fault_of_name(std::string_view name);

/// Throws InputError, for `file`, unless each name can be one and none is used twice.
void check_names(const Names& names, const std::string& file);

// The numbers of entries "5=inlet" and "10.5=land"; none if the text is something else.
[[nodiscard]] std::optional<std::int32_t> marker_from(std::string_view text);
[[nodiscard]] std::optional<double> region_from(std::string_view text);

/// For readers of files in which other programs give names as they please: adds a name, and leaves out what cannot be
/// one, or is one already.
void add_marker_name(Names& names, std::int32_t marker, std::string name);
void add_region_name(Names& names, double region, std::string name);

/// Writes names to a ByteWriter, or reads them from a ByteReader.
template <class Stream, class AllNames>
void transfer_names(Stream& stream, AllNames& names) {
  const auto transfer = [&](auto& map) {
    if constexpr (requires { stream.bytes(); }) {
      stream.value(std::uint64_t{map.size()});
      for (const auto& [value, name] : map) {
        stream.value(value);
        stream.text(name);
      }
    } else {
      for (auto left = stream.template value<std::uint64_t>(); left > 0; --left) {
        const auto value = stream.template value<typename std::decay_t<decltype(map)>::key_type>();
        map[value] = stream.text();
      }
    }
  };
  transfer(names.markers);
  transfer(names.regions);
}

}  // namespace driftmesh
