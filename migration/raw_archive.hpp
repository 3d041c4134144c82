#pragma once

#include <cstddef>
#include <memory>

#include "migration/packed_bytes.hpp"

namespace driftmesh {

/// Saves bytes as they are in memory, by a binary archive of Boost.Serialization; in a build without Boost, the same
/// bytes without one.
class RawWriter {
 public:
  explicit RawWriter(SealedBytes& bytes);
  ~RawWriter();
  void save(const void* data, std::size_t size);

 private:
  struct Archive;
  std::unique_ptr<Archive> archive_;
};

/// Loads them in the same order. Throws Error for what the archive refuses.
class RawReader {
 public:
  explicit RawReader(SealReader& bytes);
  ~RawReader();
  void load(void* to, std::size_t size);

 private:
  struct Archive;
  std::unique_ptr<Archive> archive_;
};

}  // namespace driftmesh
