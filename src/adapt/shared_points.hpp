#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/distributed_piece.hpp"

namespace driftmesh::adapt {

/// Tells other ranks about the points that they share with this one, and hears from them: write(point, ByteWriter&) for
/// each such point and rank, then read(point, ByteReader&, rank). Points are indices in the piece.
template <class Write, class Read>
void tell_at_shared_points(Ranks& ranks, const DistributedPiece& piece, const Write& write, const Read& read) {
  std::vector<Mail> mail;
  for (const DistributedPiece::Neighbor& neighbor : piece.neighbors) {
    ByteWriter writer;
    for (const std::int32_t point : neighbor.shared) write(point, writer);
    mail.push_back({neighbor.rank, writer.take()});
  }
  const std::vector<Mail> heard = ranks.swap(std::move(mail));
  for (std::size_t k = 0; k < heard.size(); ++k)
    read_mail(heard[k], [&](ByteReader& reader) {
      for (const std::int32_t point : piece.neighbors[k].shared) read(point, reader, heard[k].rank);
    });
}

}  // namespace driftmesh::adapt
