#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace driftmesh {

/// Unpacks what zlib packed, one block after the other.
class Unpacker {
 public:
  /// `file`: for messages. Throws InputError if this build is without zlib.
  explicit Unpacker(const std::string& file);
  ~Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  /// Begins a block, which must stay valid until the next one begins.
  void begin(std::string_view packed);
  /// Unpacks up to `count` bytes of the block to `to`; returns how many. Fewer: the block ends, or is damaged.
  [[nodiscard]] std::size_t take(char* to, std::size_t count);
  /// Whether nothing of the block is left. Known only to a take() that asked for more than there was.
  [[nodiscard]] bool at_end() const;

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace driftmesh
