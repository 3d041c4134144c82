#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace driftmesh::study {

/// JSON text, indented by this many blanks, or on one line (-1). Bytes that are not valid UTF-8, possible in file
/// names, are replaced.
template <class Json>
[[nodiscard]] std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace driftmesh::study
