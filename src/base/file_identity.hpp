#pragma once

#include <cstdint>
#include <string>
#include <tuple>

namespace driftmesh {

/// Which file a name stands for, whatever its spelling: two names of one file have equal identities, through links of
/// both kinds, "..", and mounts. A file that does not exist yet is its name in its folder.
struct FileIdentity {
  std::uint64_t device = 0;  ///< where the file is, or its folder if the file does not exist
  std::uint64_t inode = 0;
  std::string name{};  ///< empty for a file that exists; in portable builds the whole path

  friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
  friend bool operator<(const FileIdentity& a, const FileIdentity& b) {
    return std::tie(a.device, a.inode, a.name) < std::tie(b.device, b.inode, b.name);
  }
};

/// The path that symbolic links lead to from `path`, as its last component: of a file, or of one that does not exist
/// yet. Links in a circle are not followed.
[[nodiscard]] std::string link_target(const std::string& path);

/// Whether a path, which need not exist, lies in a folder or below it when all links are followed.
[[nodiscard]] bool lies_within(const std::string& path, const std::string& folder);

[[nodiscard]] FileIdentity identity_of(const std::string& path);

}  // namespace driftmesh
