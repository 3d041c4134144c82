#include "job/failure.hpp"

#include <vector>

#include "base/failure.hpp"

namespace driftmesh::job {
namespace {

Bytes bytes_of(const Failure& failure) {
  ByteWriter writer;
  failure.write(writer);
  return writer.take();
}

Failure failure_in(const Bytes& bytes) {
  ByteReader reader(bytes);
  return Failure::read(reader);
}

/// The one of all ranks' failures that is thrown: that of the lowest rank.
Failure first_of(const std::vector<Bytes>& failures) {
  for (const Rank rank : first_ids<Rank>(failures.size())) {
    Failure failure = met_by(rank, failure_in(failures[to_index(rank)]));
    if (failure.kind != Failure::Kind::kNothing) return failure;
  }
  return {};
}

}  // namespace

void agree_on_failure(Team& team, const std::exception_ptr& own) {
  if (team.alone() && own) std::rethrow_exception(own);
  if (team.alone()) return;
  const std::vector<Bytes> failures = team.gather(bytes_of(failure_of(own)));
  const Failure first = failure_in(team.broadcast(team.leads() ? bytes_of(first_of(failures)) : Bytes()));
  if (first.kind != Failure::Kind::kNothing) raise(first);
}

}  // namespace driftmesh::job
