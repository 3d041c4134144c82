#pragma once

#include <nlohmann/json.hpp>

#include "job/request.hpp"
#include "job/value.hpp"

namespace driftmesh::config {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json json_of(const job::Value& value);

/// All keys of a request that `entry_points` know, by their full names, with their values.
[[nodiscard]] Json json_of(const job::Request& request, unsigned entry_points);

}  // namespace driftmesh::config
