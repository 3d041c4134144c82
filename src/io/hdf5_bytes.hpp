#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "base/bytes.hpp"
#include "io/hdf5_format.hpp"

namespace driftmesh {

// Arrays of bytes in an HDF5 file, by their names, with the version of what they mean. One process makes the file; then
// any process writes to the places of its arrays, whatever the others do meanwhile.

/// `file` exists and is replaced; messages call it `path`. Throws FileError.
[[nodiscard]] Hdf5Places create_hdf5_bytes(const std::string& file, const std::string& path, std::int64_t version,
                                           const std::map<std::string, std::uint64_t>& sizes);

/// Throws FileError.
void write_hdf5_bytes(const std::string& file, const std::string& path, std::uint64_t place,
                      std::span<const std::byte> bytes);

/// Such a file, to be read.
class Hdf5Bytes {
 public:
  /// Throws InputError if it is none, or has content elsewhere (see require_own_content); FileError.
  explicit Hdf5Bytes(const std::string& path);

  /// Whether it is a file of a mesh instead, which has no version.
  [[nodiscard]] bool is_mesh() const { return is_mesh_; }
  [[nodiscard]] std::int64_t version() const { return version_; }
  [[nodiscard]] bool has(const std::string& array) const { return arrays_.contains(array); }
  /// Throws InputError if the file has no such array, or ends before these bytes do.
  [[nodiscard]] std::uint64_t size_of(const std::string& array) const;
  [[nodiscard]] Bytes read(const std::string& array, std::uint64_t first, std::uint64_t count) const;

 private:
  struct Array {
    std::uint64_t place = 0;
    std::uint64_t size = 0;
  };
  [[nodiscard]] const Array& array(const std::string& name) const;

  std::string path_;
  bool is_mesh_ = false;
  std::int64_t version_ = 0;
  std::map<std::string, Array> arrays_;
};

}  // namespace driftmesh
