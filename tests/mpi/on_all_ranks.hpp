#pragma once

#include <doctest/doctest.h>
#include <mpi.h>

#include <string>

#include "driftmesh/error.hpp"
#include "temporary_folder.hpp"

namespace driftmesh::mpi_test {

inline int own_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

inline int rank_count() {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

/// A path in the folder of rank 0. Collective.
inline std::string shared_path(const TemporaryFolder& folder, const std::string& name) {
  std::string path = (folder.path() / name).string();
  path.resize(200);
  MPI_Bcast(path.data(), 200, MPI_CHAR, 0, MPI_COMM_WORLD);
  return path.c_str();
}

/// The message of the Error that a call throws on this rank, and CHECKs that it is the same on all. Collective.
template <class Call>
std::string common_error(Call call) {
  std::string said = "nothing";
  try {
    call();
  } catch (const Error& error) {
    said = error.what();
  }
  std::string of_first = said;
  of_first.resize(1000);
  MPI_Bcast(of_first.data(), 1000, MPI_CHAR, 0, MPI_COMM_WORLD);
  CHECK(said == of_first.c_str());
  return said;
}

}  // namespace driftmesh::mpi_test
