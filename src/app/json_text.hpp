#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace driftmesh::app {

/// JSON as a file holds it, by lines indented by so many blanks, or in one line (-1). What is no UTF-8, as names of
/// files need not be, is replaced.
template <class Json>
[[nodiscard]] std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace driftmesh::app
