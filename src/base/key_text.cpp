#include "base/key_text.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/assert.hpp"

namespace driftmesh {

KeyText::KeyText(std::string text) {
  if (!text.empty()) parts_.push_back({std::move(text), false});
}

void KeyText::add(std::string_view text, bool is_key) {
  if (!text.empty()) parts_.push_back({std::string(text), is_key});
}

KeyText KeyText::filled(std::string_view pattern, std::span<const KeyText> values) {
  KeyText made;
  std::size_t used = 0;
  for (std::size_t at = 0, after = 0; at < pattern.size(); at = after) {
    const std::size_t open = std::min(pattern.find('{', at), pattern.size());
    made.add(pattern.substr(at, open - at), false);
    if (open == pattern.size()) break;
    const std::size_t close = std::min(pattern.find('}', open), pattern.size());
    DM_ASSERT(close < pattern.size());
    after = close + 1;
    if (const std::string_view key = pattern.substr(open + 1, close - open - 1); !key.empty()) {
      made.add(key, true);
    } else {
      DM_ASSERT(used < values.size());
      if (used == values.size()) continue;
      const std::vector<Part>& parts = values[used++].parts_;
      made.parts_.insert(made.parts_.end(), parts.begin(), parts.end());
    }
  }
  return made;
}

std::string KeyText::in(const Words& words) const {
  std::string text;
  for (const Part& part : parts_) text += part.is_key ? words(part.text) : part.text;
  return text;
}

void KeyText::write(ByteWriter& writer) const {
  writer.value(static_cast<std::uint64_t>(parts_.size()));
  for (const Part& part : parts_) {
    writer.value(part.is_key);
    writer.text(part.text);
  }
}

KeyText KeyText::read(ByteReader& reader) {
  KeyText text;
  for (auto count = reader.value<std::uint64_t>(); count > 0; --count) {
    const auto is_key = reader.value<bool>();
    text.parts_.push_back({reader.text(), is_key});
  }
  return text;
}

}  // namespace driftmesh
