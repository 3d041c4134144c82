#include "job/sleeping_room.hpp"

#include "base/words.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::job {

std::unique_ptr<ScratchFile> open_scratch(const std::string& folder, double triangles) {
  if (folder.empty()) return nullptr;
  constexpr double kBytesOnDisk = 10;  // per triangle
  auto file = std::make_unique<ScratchFile>(folder);
  const auto needed = static_cast<std::uint64_t>(kBytesOnDisk * triangles);
  if (const std::uint64_t room = file->room(); room < needed)
    throw FileError(folder + ": has " + bytes_words(room) + " free, but " + estimate_words(triangles) +
                    " triangles asleep take about " + bytes_words(needed) +
                    "; name a folder on a larger disk with --scratch, or ask for larger triangles");
  return file;
}

}  // namespace driftmesh::job
