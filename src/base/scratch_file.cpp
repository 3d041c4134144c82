#include "base/scratch_file.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {

ScratchFile::ScratchFile(std::string folder) : folder_(std::move(folder)), file_(std::in_place, folder_) {}

ScratchFile::Piece ScratchFile::put(std::initializer_list<std::span<const std::byte>> parts) {
  std::uint64_t bytes = 0;
  for (const auto part : parts) bytes += part.size();
  Piece piece(*this, end_.fetch_add(bytes), bytes);
  std::uint64_t place = piece.begin_;
  for (const auto part : parts) {
    file_->write(place, part);
    place += part.size();
  }
  return piece;
}

std::uint64_t ScratchFile::room() const {
  std::error_code failed;
  const std::uintmax_t room = std::filesystem::space(folder_, failed).available;
  if (failed) throw FileError(folder_, "cannot tell the free space of");
  return room;
}

ScratchFile::Piece::Piece(Piece&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), begin_(other.begin_), bytes_(other.bytes_) {}

ScratchFile::Piece& ScratchFile::Piece::operator=(Piece&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(begin_, other.begin_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

ScratchFile::Piece::~Piece() {
  if (file_ == nullptr || !file_->file_ || bytes_ == 0) return;
  file_->file_->give_back(begin_, bytes_);
}

void ScratchFile::Piece::read(std::uint64_t offset, std::span<std::byte> to) const {
  file_->file_->read(begin_ + offset, to);
}

}  // namespace driftmesh
