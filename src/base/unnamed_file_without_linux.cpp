#include <cerrno>
#include <cstdio>
#include <fstream>
#include <mutex>

#include "base/temporary_files.hpp"
#include "base/unnamed_file.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

struct UnnamedFile::Opened {
  explicit Opened(const std::string& path)
      : name(path), noted(path), stream(path, std::ios::in | std::ios::out | std::ios::trunc | std::ios::binary) {}
  ~Opened() {
    stream.close();
    std::remove(name.c_str());
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  std::string name;
  NotedTemporary noted;
  std::mutex alone;  // the stream has one position
  std::fstream stream;
};

UnnamedFile::UnnamedFile(const std::string& folder)
    : folder_(folder), opened_(std::make_unique<Opened>(temporary_name(folder + "/scratch"))) {
  if (!opened_->stream.is_open()) fail("cannot keep scratch data in this folder");
}

UnnamedFile::~UnnamedFile() = default;

void UnnamedFile::write(std::uint64_t place, std::span<const std::byte> bytes) {
  const std::lock_guard lock(opened_->alone);
  opened_->stream.seekp(static_cast<std::streamoff>(place));
  opened_->stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!opened_->stream.flush()) fail("cannot write scratch data to");
}

void UnnamedFile::read(std::uint64_t place, std::span<std::byte> to) const {
  const std::lock_guard lock(opened_->alone);
  opened_->stream.seekg(static_cast<std::streamoff>(place));
  if (!opened_->stream.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size())))
    fail("cannot read scratch data from");
}

void UnnamedFile::give_back(std::uint64_t, std::uint64_t) noexcept {}

void UnnamedFile::fail(const char* what) const {
  throw FileError(folder_, what);
}

}  // namespace driftmesh
