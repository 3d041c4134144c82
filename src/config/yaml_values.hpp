#pragma once

#include <yaml-cpp/yaml.h>

#include "config/yaml_origin.hpp"
#include "job/keys.hpp"

namespace driftmesh::config {

/// The value that a node of YAML gives to a key, or to one entry of a table. Names of files are resolved as by Origin.
/// Throws InputError, with the place of the node, if it has the wrong type, a field that the key does not have, a value
/// out of range, or an output that leads out of the folder.
[[nodiscard]] job::Value value_of(const job::KeyPath& path, const YAML::Node& node, const Origin& origin);

}  // namespace driftmesh::config
