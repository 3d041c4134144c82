#include "job/outputs.hpp"

#include "base/bytes.hpp"
#include "job/failure.hpp"

namespace driftmesh::job {

void commit(Team& team, StagedFiles& files) {
  for (const bool leaders_turn : {false, true})
    agree(team, [&] {
      if (team.leads() == leaders_turn) files.appear();
    });
  files.finish();
}

std::vector<StagedFiles::Listed> staged_by_all(Team& team, const StagedFiles& files) {
  std::vector<StagedFiles::Listed> own = files.files();
  if (team.alone()) return own;
  ByteWriter writer;
  writer.value(own.size());
  for (const StagedFiles::Listed& file : own) {
    writer.text(file.path);
    writer.value(file.bytes);
  }
  const std::vector<Bytes> of_ranks = team.gather(writer.take());
  if (!team.leads()) return own;
  std::vector<StagedFiles::Listed> all;
  for (const Bytes& bytes : of_ranks) {
    ByteReader reader(bytes);
    for (auto left = reader.value<std::size_t>(); left > 0; --left) {
      StagedFiles::Listed& file = all.emplace_back();
      file.path = reader.text();
      reader.value(file.bytes);
    }
  }
  return all;
}

}  // namespace driftmesh::job
