#include "base/file_identity.hpp"

#ifndef DRIFTMESH_PORTABLE
#include <sys/stat.h>
#endif

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

namespace driftmesh {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as Linux allows

#ifdef DRIFTMESH_PORTABLE

/// Hard links to one file are several then.
std::optional<FileIdentity> existing(const std::string& path) {
  std::error_code failed;
  const fs::path found = fs::canonical(path, failed);
  if (failed) return std::nullopt;
  return FileIdentity{0, 0, found.string()};
}

FileIdentity in_folder(const FileIdentity& folder, const fs::path& name) {
  return {0, 0, (fs::path(folder.name) / name).string()};
}

#else

std::optional<FileIdentity> existing(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileIdentity{status.st_dev, status.st_ino, ""};
}

FileIdentity in_folder(const FileIdentity& folder, const fs::path& name) {
  return {folder.device, folder.inode, name.string()};
}

#endif

}  // namespace

std::string link_target(const std::string& path) {
  fs::path at = path;
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code failed;
    if (!fs::is_symlink(at, failed)) return at.string();
    const fs::path next = fs::read_symlink(at, failed);
    if (failed) return at.string();
    at = at.parent_path() / next;  // an absolute one replaces it
  }
  return path;
}

bool lies_within(const std::string& path, const std::string& folder) {
  std::error_code failed;
  const fs::path outer = fs::weakly_canonical(fs::absolute(folder), failed);
  if (failed) return false;
  const fs::path inner = fs::weakly_canonical(fs::absolute(link_target(path)), failed);
  if (failed) return false;
  const auto [end, differs] = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return end == outer.end() || (end->empty() && std::next(end) == outer.end());  // "folder/" ends in an empty name
}

FileIdentity identity_of(const std::string& path) {
  if (const auto found = existing(path)) return *found;
  const fs::path target = link_target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (const auto in = existing(folder.string())) return in_folder(*in, target.filename());
  return {0, 0, fs::absolute(target).lexically_normal().string()};
}

}  // namespace driftmesh
