#include "io/tag_comments.hpp"

#include <algorithm>
#include <string>

#include "pslg/names.hpp"

namespace driftmesh {
namespace {

constexpr std::string_view kMarker = "driftmesh marker ";
constexpr std::string_view kRegion = "driftmesh region ";

std::string_view up_to_blank(std::string_view& text) {
  const std::string_view word = text.substr(0, text.find(' '));
  text.remove_prefix(word.size() + (word.size() < text.size() ? 1 : 0));
  return word;
}

template <class Value>
void write_comment(FileSink& sink, std::string_view kind, std::int32_t tag, Value value, std::string_view name) {
  sink.text("# ");
  sink.text(kind);
  sink.number(tag);
  sink.character(' ');
  sink.number(value);
  if (!name.empty()) sink.character(' ');
  sink.text(name);
  sink.character('\n');
}

template <class Value>
std::string_view name_of(const std::map<Value, std::string>& names, Value value) {
  const auto name = names.find(value);
  return name == names.end() ? std::string_view() : std::string_view(name->second);
}

}  // namespace

void TagComments::read(std::string_view comment) {
  comment.remove_prefix(std::min(comment.find_first_not_of(' '), comment.size()));
  const bool is_marker = comment.starts_with(kMarker);
  if (!is_marker && !comment.starts_with(kRegion)) return;
  comment.remove_prefix((is_marker ? kMarker : kRegion).size());
  const auto tag = marker_from(up_to_blank(comment));
  const std::string_view value = up_to_blank(comment);
  if (!tag) return;
  if (const auto marker = marker_from(value); is_marker && marker) {
    markers[*tag] = *marker;
    if (!comment.empty()) add_marker_name(names, *marker, std::string(comment));
  } else if (const auto region = region_from(value); !is_marker && region) {
    regions[*tag] = *region;
    if (!comment.empty()) add_region_name(names, *region, std::string(comment));
  }
}

std::int32_t TagComments::marker_of(std::int32_t tag) const {
  const auto marker = markers.find(tag);
  return marker == markers.end() ? tag : marker->second;
}

double TagComments::region_of(std::int32_t tag) const {
  const auto region = regions.find(tag);
  return region == regions.end() ? tag : region->second;
}

void write_tag_comments(FileSink& sink, const std::map<double, std::int32_t>& marker_tags,
                        const std::map<double, std::int32_t>& region_tags, const Names& names) {
  for (const auto& [value, tag] : marker_tags) {
    const auto marker = static_cast<std::int32_t>(value);
    const std::string_view name = name_of(names.markers, marker);
    if (tag != marker || !name.empty()) write_comment(sink, kMarker, tag, marker, name);
  }
  for (const auto& [region, tag] : region_tags)
    write_comment(sink, kRegion, tag, region, name_of(names.regions, region));
}

}  // namespace driftmesh
