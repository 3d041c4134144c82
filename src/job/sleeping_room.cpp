#include "job/sleeping_room.hpp"

#include "base/key_error.hpp"
#include "base/words.hpp"

namespace driftmesh::job {

std::unique_ptr<ScratchFile> open_scratch(const std::string& folder, double triangles) {
  if (folder.empty()) return nullptr;
  constexpr double kBytesOnDisk = 10;  // per triangle
  auto file = std::make_unique<ScratchFile>(folder);
  const auto needed = static_cast<std::uint64_t>(kBytesOnDisk * triangles);
  if (const std::uint64_t room = file->room(); room < needed)
    throw Keyed<FileError>(
        KeyText::of("{}: has {} free, but {} triangles asleep take about {}; name a folder on a larger disk with "
                    "{run.scratch}, or ask for larger triangles",
                    folder, bytes_words(room), estimate_words(triangles), bytes_words(needed)));
  return file;
}

}  // namespace driftmesh::job
