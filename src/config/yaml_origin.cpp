#include "config/yaml_origin.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/file_identity.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::config {
namespace {

const std::string kSetting = "--set ";

}  // namespace

Origin::Origin(std::string name, std::string folder, bool has_lines)
    : name_(std::move(name)), folder_(std::move(folder)), has_lines_(has_lines) {}

Origin Origin::file(const std::string& path) {
  return {path, std::filesystem::path(path).parent_path().string(), true};
}

Origin Origin::setting(const std::string& text) {
  return {kSetting + text, "", false};
}

bool Origin::is_setting(const std::string& place) {
  return place.starts_with(kSetting);
}

std::string Origin::place(const YAML::Mark& mark) const {
  if (!has_lines_ || mark.is_null()) return name_;
  return name_ + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
}

void Origin::fail(const YAML::Mark& mark, const std::string& what, const std::string& next) const {
  throw InputError({place(mark)}, what, next);
}

std::string Origin::resolved(const std::string& file) const {
  return file.empty() || is_standard_stream(file) || folder_.empty() ? file
                                                                     : (std::filesystem::path(folder_) / file).string();
}

std::string Origin::resolved_output(const std::string& file) const {
  std::string path = resolved(file);
  const bool inside = is_standard_stream(file) || lies_within(path, folder_.empty() ? "." : folder_);
  return inside ? path : "";
}

YAML::Node Origin::parse(const std::string& text) const {
  refuse_control_characters(text);
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    fail(error.mark, error.msg, "this is not YAML");
  }
}

/// At some of them the parser would take the text for complete.
void Origin::refuse_control_characters(const std::string& text) const {
  const auto found =
      std::ranges::find_if(text, [](unsigned char c) { return c < ' ' && c != '\n' && c != '\r' && c != '\t'; });
  if (found == text.end()) return;
  const auto line = 1 + static_cast<std::size_t>(std::count(text.begin(), found, '\n'));
  throw InputError({name_, has_lines_ ? line : 0}, "holds a control character", "this is not YAML");
}

}  // namespace driftmesh::config
