#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "base/temporary_files.hpp"
#include "base/write_behind.hpp"

namespace driftmesh {

/// A file that appears under its name only when it is complete. Bytes go to a temporary file in the same folder;
/// commit() renames it over `path`, or leaves that to the StagedFiles of this thread, if there are any. A file that is
/// replaced hands on its permissions, and its owner if this process may do that. Destroyed without commit, it removes
/// the temporary and leaves `path` as it was; so does a signal that ends the process (see temporary_files.hpp). A link
/// is followed; what is not a regular file (a pipe, /dev/null) is written to directly, and so is standard output (see
/// is_standard_stream), which can be used only once: InputError. Every operation throws FileError that names `path` and
/// the system's reason (disk full, no permission, ...).
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes; small writes are gathered in a buffer, large ones are not copied.
  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Bytes written so far.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Its name until commit(), for those who write it by name. Throws InputError unless it will be a regular file.
  [[nodiscard]] const std::string& name_meanwhile() const;
  /// Flushes, closes and renames, or stages. Nothing may be written afterward.
  void commit();

 private:
  void open();
  void write_large(const char* bytes, std::size_t count);
  [[noreturn]] void fail(const char* what);
  void close_and_remove() noexcept;

  std::string path_;       // as the user named it, for messages
  std::string target_;     // after following links
  std::string temporary_;  // empty when writing directly
  std::unique_ptr<NotedTemporary> noted_;
  std::unique_ptr<char[]> buffer_;
  std::FILE* stream_ = nullptr;
  std::uint64_t size_ = 0;
  WriteBehind behind_;
};

}  // namespace driftmesh
