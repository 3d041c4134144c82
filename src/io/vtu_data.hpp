#pragma once

#include <string>
#include <string_view>

#include "io/vtu_header.hpp"

namespace driftmesh {

class EncodedBytes;

/// The data of a .vtu's arrays: appended or in their elements; as bytes, in base64 or as text; compressed by zlib or
/// not.
class VtuData {
 public:
  /// Throws InputError if the appended data are not those of the arrays: overlapping, cut off, or followed by more.
  /// Both arguments must outlive the object.
  VtuData(const std::string& file, const VtuHeader& header);

  /// The bytes of a binary array, in `storage` if they are not in the file as they are. Throws InputError unless there
  /// are `count`; nothing is allocated that the data cannot fill.
  [[nodiscard]] std::string_view bytes(const VtuHeader::Array& array, std::uint64_t count, std::string& storage) const;

 private:
  /// The sizes in front of compressed data.
  struct Blocks {
    std::uint64_t size = 0;  // of each but the last, uncompressed
    std::uint64_t last = 0;
    std::vector<std::uint64_t> compressed;
    [[nodiscard]] std::uint64_t total() const;
  };

  [[nodiscard]] EncodedBytes encoded(const VtuHeader::Array& array) const;
  [[nodiscard]] std::uint64_t length(EncodedBytes& in, const VtuHeader::Array& array) const;
  [[nodiscard]] Blocks blocks(EncodedBytes& in, const VtuHeader::Array& array) const;
  [[nodiscard]] std::size_t end_of(const VtuHeader::Array& array) const;
  void check_appended() const;
  void inflate(EncodedBytes& in, const Blocks& blocks, const VtuHeader::Array& array, std::string& out) const;
  void require_count(const VtuHeader::Array& array, std::uint64_t actual, std::uint64_t expected) const;
  [[noreturn]] void fail(const VtuHeader::Array& array, const std::string& what) const;

  const std::string& file_;
  const VtuHeader& header_;
};

}  // namespace driftmesh
