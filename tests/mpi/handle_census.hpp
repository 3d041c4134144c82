#pragma once

#include <cstddef>

namespace driftmesh::mpi_test {

/// MPI handles that this process has created and not freed. A program linked with handle_census.cpp counts them,
/// including those of its libraries.
struct HandleCensus {
  std::size_t communicators = 0;
  std::size_t requests = 0;  ///< open messages between ranks
  friend bool operator==(const HandleCensus&, const HandleCensus&) = default;
};
[[nodiscard]] HandleCensus handle_census();

}  // namespace driftmesh::mpi_test
