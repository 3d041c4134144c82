#include "base/built_without.hpp"
#include "mapping/mapping_file.hpp"

namespace driftmesh {

std::vector<std::string> mapping_files(const std::string& path) {
  return {path};
}

Assignment read_mapping(const std::string& path, std::int32_t /*subdomains*/, std::int32_t /*ranks*/) {
  throw built_without("nlohmann-json", "JSON", path, "map by another method");
}

}  // namespace driftmesh
