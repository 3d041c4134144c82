#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "driftmesh/pslg.hpp"
#include "geometry/triangle_geometry.hpp"
#include "sizing/size_tree.hpp"

namespace driftmesh {

// A compiled size field as a file: a line that says what it is, then numbers of fixed layout, lowest byte first. The
// version, a digest of the domain, the length of the tree and its checksum, 8 bytes each; then the tree (see
// SizeTree::pack).

/// What a tree is compiled for: the coordinates of points and the segments of a repaired domain.
[[nodiscard]] std::uint64_t domain_digest(const Pslg& pslg);

/// Writes the tree, with all squares that meet the triangles of the domain. The file appears when it is complete.
/// Throws InputError where lengths are known at points alone, and FileError.
void write_size_tree(const SizeTree& tree, std::span<const CornerPoints> domain, std::uint64_t digest,
                     const std::string& path);

/// Reads such a file: the same lengths, to the last bit, in its domain. `digest`: the domain that it has to be for; any
/// if not given. Throws InputError for another domain, another version or what is no such file, and FileError.
[[nodiscard]] std::unique_ptr<SizeTree> read_size_tree(const std::string& path,
                                                       std::optional<std::uint64_t> digest = std::nullopt);

}  // namespace driftmesh
