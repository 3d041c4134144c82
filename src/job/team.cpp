#include "job/team.hpp"

#include <cstdlib>
#include <exception>

#include "base/failure.hpp"
#include "base/temporary_files.hpp"
#include "job/limits.hpp"

namespace driftmesh::job {

void fail_alone(Team& team) {
  if (team.alone()) throw;
  remove_noted_temporaries();  // nothing is destroyed
  const Failure failure = failure_of(std::current_exception());
  team.abort(KeyText::of("driftmesh: rank {}: {}", to_string(team.rank()), text_of(failure)),
             failure.kind == Failure::Kind::kLimit ? kStoppedByLimit : EXIT_FAILURE);
  std::abort();  // not reached
}

}  // namespace driftmesh::job
