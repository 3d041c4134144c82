#include "io/vtu_data.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/encoded_bytes.hpp"
#include "io/read_checks.hpp"

namespace driftmesh {
namespace {

/// More than any data shrink under zlib (1,032 times): what claims to is damaged.
constexpr std::uint64_t kMostShrunk = 1040;

}  // namespace

VtuData::VtuData(const std::string& file, const VtuHeader& header) : file_(file), header_(header) {
  check_appended();
}

std::uint64_t VtuData::Blocks::total() const {
  if (compressed.empty()) return 0;
  return last == 0 ? compressed.size() * size : (compressed.size() - 1) * size + last;
}

void VtuData::fail(const VtuHeader::Array& array, const std::string& what) const {
  throw InputError({file_, array.line}, "a DataArray " + what, kDamaged);
}

EncodedBytes VtuData::encoded(const VtuHeader::Array& array) const {
  if (array.format != VtuHeader::Format::kAppended) return {array.text, false};
  if (array.offset > header_.appended.size()) fail(array, "begins behind the end of the file");
  return {header_.appended.substr(array.offset), header_.raw};
}

std::uint64_t VtuData::length(EncodedBytes& in, const VtuHeader::Array& array) const {
  const std::size_t size = header_.wide_lengths ? 8 : 4;
  std::string bytes;
  if (!in.take(size, bytes)) fail(array, "ends within its lengths");
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data(), size);  // of little-endian bytes on a little-endian machine (file_sink.hpp)
  return value;
}

VtuData::Blocks VtuData::blocks(EncodedBytes& in, const VtuHeader::Array& array) const {
  const std::uint64_t count = length(in, array);
  Blocks blocks;
  blocks.size = length(in, array);
  blocks.last = length(in, array);
  if (count > in.room() / (header_.wide_lengths ? 8 : 4)) fail(array, "announces more blocks than the file can hold");
  std::uint64_t stored = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    blocks.compressed.push_back(length(in, array));
    if (blocks.compressed.back() > in.room()) fail(array, "has a block that is larger than the file");
    stored += blocks.compressed.back();
  }
  if (stored > in.room()) fail(array, "is cut off");
  return blocks;
}

/// In the characters of the appended section.
std::size_t VtuData::end_of(const VtuHeader::Array& array) const {
  EncodedBytes in = encoded(array);
  std::uint64_t stored = 0;
  if (header_.compressed)
    for (const std::uint64_t size : blocks(in, array).compressed) stored += size;
  else
    stored = length(in, array);
  if (!in.skip(stored)) fail(array, "is cut off");
  return array.offset + in.position();
}

void VtuData::check_appended() const {
  std::vector<const VtuHeader::Array*> arrays;
  for (const auto& [name, array] : header_.arrays) arrays.push_back(&array);
  for (const VtuHeader::Array& array : header_.other_arrays) arrays.push_back(&array);
  std::erase_if(arrays, [](const auto* array) { return array->format != VtuHeader::Format::kAppended; });
  if (header_.appended.data() == nullptr) return;
  std::sort(arrays.begin(), arrays.end(), [](const auto* a, const auto* b) { return a->offset < b->offset; });
  std::size_t end = 0;
  for (const VtuHeader::Array* array : arrays) {
    if (array->offset < end) fail(*array, "overlaps another one");
    end = end_of(*array);
  }
  ByteCursor rest(file_, header_.appended.substr(end));
  for (const std::string_view tag : {"</AppendedData>", "</VTKFile>"}) {
    rest.skip_blanks();
    if (!rest.rest().starts_with(tag))
      throw InputError({file_, 0}, "has no " + std::string(tag) + " where its data end", kDamaged);
    static_cast<void>(rest.take_bytes(tag.size(), 1, "its last tags"));
  }
  rest.skip_blanks();
  if (rest.remaining() > 0) throw InputError({file_, 0}, "has more behind </VTKFile>", kDamaged);
}

void VtuData::require_count(const VtuHeader::Array& array, std::uint64_t actual, std::uint64_t expected) const {
  if (actual != expected)
    fail(array, "holds " + std::to_string(actual) + " bytes of " + array.type + ", not " + std::to_string(expected));
}

std::string_view VtuData::bytes(const VtuHeader::Array& array, std::uint64_t count, std::string& storage) const {
  EncodedBytes in = encoded(array);
  std::string_view view;
  if (header_.compressed) {
    const Blocks stored = blocks(in, array);
    require_count(array, stored.total(), count);
    inflate(in, stored, array, storage);
    view = storage;
  } else {
    require_count(array, length(in, array), count);
    if (!in.take_view(count, view)) {
      if (!in.take(count, storage)) fail(array, "is cut off");
      view = storage;
    }
  }
  if (array.format != VtuHeader::Format::kAppended &&
      !std::all_of(array.text.begin() + static_cast<std::ptrdiff_t>(in.position()), array.text.end(),
                   ByteCursor::is_blank))
    fail(array, "has more data than announced");
  return view;
}

void VtuData::inflate(EncodedBytes& in, const Blocks& blocks, const VtuHeader::Array& array, std::string& out) const {
  out.clear();
  std::string packed;
  for (std::size_t i = 0; i < blocks.compressed.size(); ++i) {
    const bool is_last = i + 1 == blocks.compressed.size();
    const std::uint64_t size = is_last && blocks.last != 0 ? blocks.last : blocks.size;
    if (size / kMostShrunk > blocks.compressed[i]) fail(array, "has a block of impossible size");
    if (!in.take(blocks.compressed[i], packed)) fail(array, "is cut off");
    const std::size_t begin = out.size();
    out.resize(begin + size);
    uLongf made = size;
    uLong taken = packed.size();
    const int result = ::uncompress2(reinterpret_cast<Bytef*>(out.data() + begin), &made,
                                     reinterpret_cast<const Bytef*>(packed.data()), &taken);
    if (result != Z_OK || made != size || taken != packed.size())
      fail(array, "has block " + std::to_string(i) + " (counted from 0) that zlib cannot unpack as announced");
  }
}

}  // namespace driftmesh
