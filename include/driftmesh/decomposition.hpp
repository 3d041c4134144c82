#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// A domain cut into subdomains, for MeshOptions::Subdomains::given. Opaque to callers.
struct Decomposition;

/// Cuts the domain for a mesh with these options on `ranks` ranks: subdomains of about equal expected work, with short
/// straight borders that meet everything at wide angles. Deterministic. Throws like mesh(), and Error if the domain
/// cannot be cut into the requested number of subdomains.
///
/// \code
/// const driftmesh::Pslg pipe = driftmesh::generate("pipe");
/// driftmesh::MeshOptions options{.max_area = 50};
/// options.subdomains.count = 40;
/// driftmesh::save_decomposition(*driftmesh::cut_domain(pipe, options), pipe, "pipe.json");
///
/// driftmesh::MeshOptions finer{.max_area = 20};  // in the same subdomains
/// finer.subdomains.given = driftmesh::load_decomposition("pipe.json", pipe);
/// const driftmesh::Mesh mesh = driftmesh::mesh(pipe, finer);
/// \endcode
[[nodiscard]] std::shared_ptr<const Decomposition> cut_domain(const Pslg& input, const MeshOptions& options,
                                                              std::int32_t ranks = 1);

/// The number of subdomains.
[[nodiscard]] std::int32_t subdomains_of(const Decomposition& decomposition);

/// Reads a file written by `driftmesh decompose` or save_decomposition. Throws FileError, and InputError for a file
/// that is damaged or was made from a different input.
[[nodiscard]] std::shared_ptr<const Decomposition> load_decomposition(const std::string& path, const Pslg& input);

/// Writes a decomposition; `input` must be the one that it was made from. The file appears only when complete. Throws
/// FileError.
void save_decomposition(const Decomposition& decomposition, const Pslg& input, const std::string& path);

}  // namespace driftmesh
