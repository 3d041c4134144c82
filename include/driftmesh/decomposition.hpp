#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// A domain cut into subdomains: see options.subdomains.given. What it consists of is not for callers.
struct Decomposition;

/// Cuts the domain for a mesh with these options on so many ranks: subdomains of about equal expected work, with short
/// straight borders that keep wide angles to everything. Deterministic. Throws like mesh(), and Error if the domain
/// cannot be cut into so many subdomains.
[[nodiscard]] std::shared_ptr<const Decomposition> cut_domain(const Pslg& input, const MeshOptions& options,
                                                              std::int32_t ranks = 1);

/// How many subdomains it has.
[[nodiscard]] std::int32_t subdomains_of(const Decomposition& decomposition);

/// A file of `driftmesh decompose`, or of save_decomposition. Throws FileError, and InputError for what is damaged, or
/// was made from another input.
[[nodiscard]] std::shared_ptr<const Decomposition> load_decomposition(const std::string& path, const Pslg& input);

/// Writes a decomposition of the input it was made from; the file appears when it is complete. Throws FileError.
void save_decomposition(const Decomposition& decomposition, const Pslg& input, const std::string& path);

}  // namespace driftmesh
