#include "api/library_request.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace driftmesh {
namespace {

constexpr const char* kOfOptions = "MeshOptions::";

/// The names that keys have in the library, by those in the table of keys.
std::map<std::string, LibraryName> library_names() {
  std::map<std::string, LibraryName> names;
  job::Request unused;
  visit_options(MeshOptions{}, unused, [&](const char* key, const char* member, const auto&, const auto&) {
    names[key] = {kOfOptions, member};
  });
  names["sizing.size"] = {kOfOptions, "size"};  // a function, which no key can hold
  names["allow-outside"] = {"ReadOptions::", "allow_outside"};
  names["input.layers"] = {"", "layers"};
  return names;
}

}  // namespace

job::Request request_of(const MeshOptions& options) {
  job::Request request;
  const std::int64_t no_limit = request.limits.max_triangles;
  visit_options(options, request, [](const char*, const char*, const auto& value, auto& place) { place = value; });
  if (options.max_triangles == 0) request.limits.max_triangles = no_limit;
  return request;
}

LibraryName library_name(const std::string& key) {
  static const std::map<std::string, LibraryName> names = library_names();
  if (const auto found = names.find(key); found != names.end()) return found->second;
  for (const auto& [section, owner] : {std::pair("adaptive.", "AdaptiveOptions::"), {"part.", "PartOptions::"}})
    if (key.starts_with(section)) return {owner, key.substr(std::string_view(section).size())};
  if (const std::string section = "cluster."; key.starts_with(section)) {
    std::string member = key.substr(section.size());
    std::ranges::replace(member, '-', '_');
    return {"SimulatedCluster::", member};
  }
  return {kOfOptions, key};
}

std::string words_of_library(const std::string& key) {
  const LibraryName name = library_name(key);
  return name.owner + name.member;
}

}  // namespace driftmesh
