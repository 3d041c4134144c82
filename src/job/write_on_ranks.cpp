#include "job/write_on_ranks.hpp"

#include <string>

#include "distributed/write_distributed.hpp"
#include "job/write_files.hpp"

namespace driftmesh::job {

void write_on_ranks(Team& team, const DistributedPiece& piece, const Request::Output& files,
                    const std::vector<Point>& holes, const Draw& draw, Watch& watch) {
  exchange_on(team, [&](ExchangeRunner& ranks) {
    timed(watch, "write", [&] {
      write_distributed(ranks, piece, files.meshes, writing_of(files, holes, watch),
                        [&](const std::string& path) { watch.writing(path); });
    });
    if (!draw) return;
    timed(watch, "plot", [&] {
      GatherPieces gathering(piece);
      ranks.run(gathering);
      if (piece.rank == Rank{0}) draw(gathering.whole());
    });
  });
}

}  // namespace driftmesh::job
