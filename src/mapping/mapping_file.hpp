#pragma once

#include <string>
#include <vector>

#include "mapping/mapping.hpp"

namespace driftmesh {

/// The files of a mapping: `path`, and, if it is that of rank 0 ("data.0.json"), those of the following ranks beside
/// it.
[[nodiscard]] std::vector<std::string> mapping_files(const std::string& path);

/// Reads a mapping of `subdomains` subdomains to `ranks` ranks from load balancing statistics of DARMA vt (`path` as
/// above): as this program writes them, and LBAF after it has moved tasks. Of the last phase, the `node` of each
/// migratable task is the rank of the subdomain that its entity's `index` names, or its `id` in vt's encoding. Throws
/// InputError where tasks do not name each subdomain once, or name other ones or ranks; FileError.
[[nodiscard]] Assignment read_mapping(const std::string& path, std::int32_t subdomains, std::int32_t ranks);

}  // namespace driftmesh
