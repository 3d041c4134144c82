#pragma once

#include <map>
#include <set>
#include <string>

#include "base/bytes.hpp"
#include "job/order.hpp"
#include "job/record.hpp"
#include "job/request.hpp"

namespace driftmesh::job {

/// What a checkpoint says of its run besides its subdomains (docs/file-formats.md), by the names of arrays: the
/// settings that decide the mesh, and the plan with all that is not made from them anew.
[[nodiscard]] std::map<std::string, Bytes> checkpoint_heads(const Request& request, const RunRecord& record,
                                                            const Order& order);

/// The request that goes on from the checkpoint that `asked` names: settings that decide the mesh are those of the
/// file, and all others those asked for. `given`: the names of the keys that somebody has set. Throws KeyError if one
/// of them decides the mesh and differs from the file; InputError for a file that is no checkpoint, FileError.
[[nodiscard]] Request resumed_request(const Request& asked, const std::set<std::string>& given);

/// The order of the run in the checkpoint that the request names, as far as it was saved: plan, input, sizes, rasters,
/// which are open; and of the record what is known. The plan deals the work that is left to so many ranks. Throws
/// InputError if the sizes are no longer those of the run.
[[nodiscard]] Order resumed_order(const Request& request, std::int32_t ranks, RunRecord& record);

}  // namespace driftmesh::job
