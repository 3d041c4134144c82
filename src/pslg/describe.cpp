#include "pslg/describe.hpp"

#include <charconv>

namespace driftmesh {
namespace {

// Appending to a named string avoids a false warning of gcc 12 about overlapping copies.
template <class Number>
void append(std::string& text, Number value) {
  char digits[32];  // the longest double has 24 characters
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

std::string coordinates(const Point& p) {
  std::string text = "(";
  append(text, p.x);
  text += ", ";
  append(text, p.y);
  return text += ')';
}

std::string vertex_name(const Pslg& pslg, std::int32_t index, const Point& p) {
  std::string text = "the new vertex ";
  if (index >= 0) {
    text = "vertex ";
    append(text, std::int64_t{index} + pslg.first_number);
    text += ' ';
  }
  return text += coordinates(p);
}

std::string length_text(double length) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, length, std::chars_format::general, 3).ptr};
}

std::string segment_name(const Pslg& pslg, std::int32_t index) {
  std::string text = "segment ";
  append(text, std::int64_t{index} + pslg.first_number);
  return text;
}

std::string polygon_name(const Pslg& pslg, std::size_t index) {
  const std::int32_t feature = pslg.polygons[index].feature;
  std::string text = feature > 0 ? "feature " : "polygon ";
  append(text, feature > 0 ? std::int64_t{feature} : static_cast<std::int64_t>(index) + 1);
  return text;
}

}  // namespace driftmesh
