#include "job/team.hpp"

#include <cstdlib>
#include <new>

#include "base/failure.hpp"
#include "base/temporary_files.hpp"
#include "driftmesh/error.hpp"
#include "job/limits.hpp"

namespace driftmesh::job {
void fail_alone(Team& team) {
  if (team.alone()) throw;
  remove_noted_temporaries();  // nothing is destroyed
  const std::string who = "driftmesh: rank " + to_string(team.rank()) + ": ";
  try {
    throw;
  } catch (const LimitError& error) {
    team.abort(who + error.what(), kStoppedByLimit);
  } catch (const std::bad_alloc&) {
    team.abort(who + kOutOfMemory, kStoppedByLimit);
  } catch (const std::exception& error) {
    team.abort(who + error.what(), EXIT_FAILURE);
  }
  std::abort();  // not reached: nothing but exceptions of the standard library's kind is thrown here
}

}  // namespace driftmesh::job
