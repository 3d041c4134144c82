#pragma once

#include <string>

namespace driftmesh::mutants {

/// How arrays behind a .vtu are stored.
struct VtuEncoding {
  bool compressed = false;  ///< by zlib, in blocks of 64 bytes
  bool base64 = false;
};

/// A .vtu that driftmesh wrote, with its arrays stored in another way.
[[nodiscard]] std::string vtu_as(const std::string& raw, const VtuEncoding& encoding);

}  // namespace driftmesh::mutants
