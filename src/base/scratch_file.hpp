#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "base/unnamed_file.hpp"

namespace driftmesh {

/// Room on disk for what memory shall not hold, in an unnamed file. Bytes are only ever appended; those that are no
/// longer needed are given back to the file system. Errors: FileError. Threads may use it at the same time.
class ScratchFile {
 public:
  /// Bytes in the file, while the object exists.
  class Piece {
   public:
    Piece(Piece&& other) noexcept;
    Piece& operator=(Piece&& other) noexcept;
    ~Piece();
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    /// Fills `to` with the bytes from `offset` on.
    void read(std::uint64_t offset, std::span<std::byte> to) const;

   private:
    friend ScratchFile;
    Piece(ScratchFile& file, std::uint64_t begin, std::uint64_t bytes) : file_(&file), begin_(begin), bytes_(bytes) {}

    ScratchFile* file_;
    std::uint64_t begin_, bytes_;
  };

  /// In this folder. Throws FileError if it cannot be written there.
  explicit ScratchFile(std::string folder);
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Writes the parts one after the other. The file must outlive the result.
  [[nodiscard]] Piece put(std::initializer_list<std::span<const std::byte>> parts);
  /// Nothing in it is needed any more: pieces may only be destroyed. The system is faster in giving up the whole file
  /// than many pieces of it, which would have to reach the disk first.
  void discard() { file_.reset(); }
  /// What its file system still has for this process.
  [[nodiscard]] std::uint64_t room() const;

 private:
  std::string folder_;
  std::optional<UnnamedFile> file_;
  std::atomic<std::uint64_t> end_ = 0;
};

}  // namespace driftmesh
