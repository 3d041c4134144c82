#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace driftmesh {

/// The contents of a file, to be read once from the beginning to the end. A file on disk is mapped, which spares a copy
/// in fresh memory; another program must not shorten it meanwhile. Standard input and pipes are read, by read_file.
class FileBytes {
 public:
  /// `first`, and errors: as read_file.
  explicit FileBytes(const std::string& path, std::string_view first = {});
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::string_view view() const { return view_; }

 private:
  /// False if the file cannot be mapped.
  [[nodiscard]] bool map(const std::string& path);

  std::string read_;
  void* mapped_ = nullptr;
  std::string_view view_;
};

}  // namespace driftmesh
