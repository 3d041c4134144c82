#include "io/vtu_data.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"
#include "io/read_checks.hpp"
#include "zlib/unpacker.hpp"

namespace driftmesh {
namespace {

/// More than any data shrink under zlib (1,032 times): what claims to is damaged.
constexpr std::uint64_t kMostShrunk = 1040;

}  // namespace

VtuData::VtuData(const std::string& file, const VtuHeader& header) : file_(file), header_(header) {
  check_appended();
}

std::uint64_t VtuData::Blocks::size_of(std::size_t block) const {
  return block + 1 == compressed.size() && last != 0 ? last : size;
}

std::uint64_t VtuData::Blocks::total() const {
  return compressed.empty() ? 0 : (compressed.size() - 1) * size + size_of(compressed.size() - 1);
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
  std::memcpy(&value, bytes.data(), size);  // little-endian bytes on a little-endian machine (file_sink.hpp)
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

std::uint64_t VtuData::announced(const VtuHeader::Array& array) const {
  EncodedBytes in = encoded(array);
  return header_.compressed ? blocks(in, array).total() : length(in, array);
}

/// Unpacks blocks one after the other.
class VtuBytes::Inflater {
 public:
  Inflater(VtuData::Blocks blocks, const VtuData& data, const VtuHeader::Array& array)
      : blocks_(std::move(blocks)), data_(data), array_(array), unpacker_(data.file_) {
    for (std::size_t i = 0; i < blocks_.compressed.size(); ++i)
      if (blocks_.size_of(i) / kMostShrunk > blocks_.compressed[i])
        data_.fail(array_, "has a block of impossible size");
  }

  /// Appends `wanted` bytes to `out`.
  void unpack(EncodedBytes& in, std::size_t wanted, std::string& out) {
    while (wanted > 0) {
      if (left_ == 0) begin_block(in);
      const std::size_t here = std::min<std::uint64_t>(left_, wanted);
      inflate_into(out, here);
      wanted -= here;
      if ((left_ -= here) == 0) end_block();
    }
  }

 private:
  void begin_block(EncodedBytes& in) {
    std::string_view packed;
    if (!in.take_view(blocks_.compressed[next_], packed)) {
      if (!in.take(blocks_.compressed[next_], decoded_)) data_.fail(array_, "is cut off");
      packed = decoded_;
    }
    unpacker_.begin(packed);
    left_ = blocks_.size_of(next_++);
  }

  void inflate_into(std::string& out, std::size_t count) {
    const std::size_t begin = out.size();
    out.resize(begin + count);
    if (unpacker_.take(out.data() + begin, count) != count) fail();
  }

  /// The stream must end here, which takes reading what follows the last byte.
  void end_block() {
    char behind = 0;
    if (unpacker_.take(&behind, 1) != 0 || !unpacker_.at_end()) fail();
  }

  [[noreturn]] void fail() const {
    data_.fail(array_,
               "has block " + std::to_string(next_ - 1) + " (counted from 0) that zlib cannot unpack as announced");
  }

  VtuData::Blocks blocks_;
  const VtuData& data_;
  const VtuHeader::Array& array_;
  Unpacker unpacker_;
  std::size_t next_ = 0;    // block
  std::uint64_t left_ = 0;  // bytes of the present block, unpacked
  std::string decoded_;
};

VtuBytes::VtuBytes(const VtuData& data, const VtuHeader::Array& array, std::uint64_t count)
    : data_(data), array_(array), in_(data.encoded(array)), left_(count) {
  std::uint64_t announced = 0;
  if (data.header_.compressed) {
    VtuData::Blocks blocks = data.blocks(in_, array);
    announced = blocks.total();
    for (const std::uint64_t size : blocks.compressed) stored_ += size;
    if (announced == count) inflater_ = std::make_unique<Inflater>(std::move(blocks), data, array);
  } else {
    announced = stored_ = data.length(in_, array);
  }
  if (announced != count)
    data.fail(array,
              "holds " + std::to_string(announced) + " bytes of " + array.type + ", not " + std::to_string(count));
  if (count == 0) require_end();
}

VtuBytes::~VtuBytes() = default;

std::string_view VtuBytes::next() {
  const std::size_t wanted = std::min<std::uint64_t>(left_, kPart);
  std::string_view part;
  if (wanted == 0) return part;
  if (inflater_ != nullptr || !in_.take_view(wanted, part)) {
    unpack(wanted);
    part = part_;
  }
  left_ -= wanted;
  if (left_ == 0) require_end();
  return part;
}

void VtuBytes::unpack(std::size_t wanted) {
  part_.clear();
  if (inflater_ != nullptr)
    inflater_->unpack(in_, wanted, part_);
  else if (!in_.take(wanted, part_))
    data_.fail(array_, "is cut off");
}

void VtuBytes::require_end() const {
  if (array_.format == VtuHeader::Format::kAppended) return;
  const std::string_view rest = array_.text.substr(in_.position());
  if (!std::all_of(rest.begin(), rest.end(), ByteCursor::is_blank)) data_.fail(array_, "has more data than announced");
}

}  // namespace driftmesh
