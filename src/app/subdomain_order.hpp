#pragma once

#include "app/run_notes.hpp"
#include "driftmesh/id_vector.hpp"
#include "job/domain.hpp"
#include "job/key.hpp"
#include "job/limits.hpp"
#include "job/order.hpp"
#include "job/request.hpp"
#include "job/triangulated.hpp"

namespace driftmesh::app {

/// What `driftmesh mesh` has each thread or rank do, with these shares of their time; kSubdomains is for threads of
/// this process, kRanks for ranks. Throws LimitError if memory will not suffice.
[[nodiscard]] job::Order order_of(const job::Request& request, job::Domain&& domain,
                                  const job::Triangulated& triangulated, job::Place place,
                                  const IdVector<Rank, double>& shares, const job::Processes& processes,
                                  RunNotes& notes);

/// Every subdomain takes the memory that the one before has freed. Under a ceiling, free memory counts as well as any
/// other, so there nothing is kept.
void reuse_memory(const job::Request::Limits& limits);

}  // namespace driftmesh::app
