#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace driftmesh {

/// Opens a file without a name in a folder, for reading and writing; -1 if that fails, with the reason in errno. Not in
/// portable builds.
[[nodiscard]] int open_without_name(const std::string& folder);

/// A file that nobody sees. It has no name, so the system removes it when the process ends, however that happens; in
/// portable builds it has one, and is removed when it is closed, and by the signals of remove_temporaries_on_signals().
/// Threads may use it at the same time. Errors: FileError, which names the folder.
class UnnamedFile {
 public:
  /// Throws FileError if it cannot be written in this folder.
  explicit UnnamedFile(const std::string& folder);
  ~UnnamedFile();
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;

  /// From a place on, counted from its beginning.
  void write(std::uint64_t place, std::span<const std::byte> bytes);
  /// Fills `to` with the bytes from a place on.
  void read(std::uint64_t place, std::span<std::byte> to) const;
  /// These bytes are no longer needed: a hole is punched, which gives the room back to file systems that know holes.
  void give_back(std::uint64_t place, std::uint64_t bytes) noexcept;

 private:
  [[noreturn]] void fail(const char* what) const;

  struct Opened;
  std::string folder_;
  std::unique_ptr<Opened> opened_;
};

}  // namespace driftmesh
