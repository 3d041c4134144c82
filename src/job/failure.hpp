#pragma once

#include <exception>

#include "job/team.hpp"

namespace driftmesh::job {

/// If some rank has failed, throws the failure of the first such rank on all ranks, with its number unless it is a
/// KeyError. A team of one rank throws its own exception. Collective; `own` is null on ranks without a failure.
void agree_on_failure(Team& team, const std::exception_ptr& own);

/// Each rank does its part, and all throw alike if one of them fails. All ranks together.
template <class Work>
void agree(Team& team, const Work& work) {
  std::exception_ptr failure;
  try {
    work();
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  agree_on_failure(team, failure);
}

}  // namespace driftmesh::job
