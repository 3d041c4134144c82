#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "adapt/fields.hpp"
#include "adapt/parcel.hpp"
#include "base/bytes.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/pslg.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::adapt {

/// What a file of a session has besides its parts (docs/file-formats.md).
struct SavedHead {
  RunPlan plan;             ///< without a size field
  std::int32_t shares = 0;  ///< see granularity.hpp; at least 1
  Pslg pslg;
  AdaptiveOptions options;
  std::int64_t generation = 0;
  Fields fields;    ///< without values
  Bytes more;       ///< what only the caller knows
  Shapes shapes{};  ///< those of some fields
};

/// Parcels to be saved.
struct Packing {
  std::vector<SubdomainId> here;  ///< on this rank, ascending
  std::function<std::uint64_t(SubdomainId)> size;
  std::function<Bytes(SubdomainId)> pack;  ///< as many bytes; called once for each, after all sizes
};

/// Writes a session into one HDF5 file, each rank its parcels. The file appears when all of it is written, or else one
/// that was there stays. Errors, on all ranks: FileError, InputError for a path that cannot hold a regular file.
/// Collective.
void save(const std::string& path, const SavedHead& head, const Packing& packing, Ranks& ranks);

/// A session as a file has it.
struct Saved {
  SavedHead head;
  std::map<SubdomainId, Parcel> parcels;  ///< those of this rank: about as many bytes as others have
};

/// Reads what save() wrote, on any number of ranks. Errors, on all of them: InputError, naming the version of a file
/// that another program made; FileError. Collective.
[[nodiscard]] Saved read_saved(const std::string& path, Ranks& ranks);

}  // namespace driftmesh::adapt
