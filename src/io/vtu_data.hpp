#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/encoded_bytes.hpp"
#include "io/vtu_header.hpp"

namespace driftmesh {

/// The data of a .vtu's arrays: appended or in their elements; as bytes, in base64 or as text; compressed by zlib or
/// not.
class VtuData {
 public:
  /// The sizes in front of compressed data.
  struct Blocks {
    std::uint64_t size = 0;  ///< bytes in each but the last, uncompressed
    std::uint64_t last = 0;
    std::vector<std::uint64_t> compressed;
    [[nodiscard]] std::uint64_t total() const;  ///< uncompressed
    [[nodiscard]] std::uint64_t size_of(std::size_t block) const;
  };

  /// Throws InputError if the appended data are not those of the arrays: overlapping, cut off, or followed by more.
  /// Both arguments must outlive the object.
  VtuData(const std::string& file, const VtuHeader& header);

  /// How many bytes a binary array announces. Throws InputError.
  [[nodiscard]] std::uint64_t announced(const VtuHeader::Array& array) const;

 private:
  friend class VtuBytes;
  [[nodiscard]] EncodedBytes encoded(const VtuHeader::Array& array) const;
  [[nodiscard]] std::uint64_t length(EncodedBytes& in, const VtuHeader::Array& array) const;
  [[nodiscard]] Blocks blocks(EncodedBytes& in, const VtuHeader::Array& array) const;
  [[nodiscard]] std::size_t end_of(const VtuHeader::Array& array) const;
  void check_appended() const;
  [[noreturn]] void fail(const VtuHeader::Array& array, const std::string& what) const;

  const std::string& file_;
  const VtuHeader& header_;
};

/// The bytes of a binary array, unpacked part by part: memory does not depend on what the array announces.
class VtuBytes {
 public:
  static constexpr std::size_t kPart = std::size_t{256} << 10;

  /// Throws InputError unless the array announces `count` bytes, and has enough for them. The arguments must outlive
  /// the object.
  VtuBytes(const VtuData& data, const VtuHeader::Array& array, std::uint64_t count);
  ~VtuBytes();
  VtuBytes(const VtuBytes&) = delete;
  VtuBytes& operator=(const VtuBytes&) = delete;

  /// The next kPart bytes, or those that are left. Valid until the next call. Throws InputError for damaged data, and
  /// with the last part if more data follow.
  [[nodiscard]] std::string_view next();
  /// How many bytes the file has for the array.
  [[nodiscard]] std::uint64_t stored() const { return stored_; }

 private:
  class Inflater;
  void unpack(std::size_t wanted);
  void require_end() const;

  const VtuData& data_;
  const VtuHeader::Array& array_;
  EncodedBytes in_;
  std::uint64_t left_;
  std::uint64_t stored_ = 0;
  std::unique_ptr<Inflater> inflater_;  // null: not compressed
  std::string part_;
};

}  // namespace driftmesh
