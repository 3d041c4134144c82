// MPI's profiling interface: each function here replaces MPI's own, which it calls by its name with a P.
#include "mpi/handle_census.hpp"

#include <mpi.h>

#include <algorithm>
#include <set>
#include <vector>

namespace {

std::set<MPI_Comm>& communicators() {
  static std::set<MPI_Comm> all;
  return all;
}
std::set<MPI_Request>& requests() {
  static std::set<MPI_Request> all;
  return all;
}

int noted(int result, MPI_Comm made) {
  if (made != MPI_COMM_NULL) communicators().insert(made);
  return result;
}
int noted(int result, MPI_Request made) {
  if (made != MPI_REQUEST_NULL) requests().insert(made);
  return result;
}

/// Forgets those of `before` that have completed: they are null now.
void forget_completed(const std::vector<MPI_Request>& before, const MPI_Request* now) {
  for (std::size_t i = 0; i < before.size(); ++i)
    if (now[i] == MPI_REQUEST_NULL) requests().erase(before[i]);
}
std::vector<MPI_Request> copy_of(int count, const MPI_Request* all) {
  return {all, all + count};
}

}  // namespace

namespace driftmesh::mpi_test {

HandleCensus handle_census() {
  return {communicators().size(), requests().size()};
}

}  // namespace driftmesh::mpi_test

extern "C" {

int MPI_Comm_dup(MPI_Comm of, MPI_Comm* made) {
  const int result = PMPI_Comm_dup(of, made);
  return noted(result, *made);
}
int MPI_Comm_split(MPI_Comm of, int color, int key, MPI_Comm* made) {
  const int result = PMPI_Comm_split(of, color, key, made);
  return noted(result, *made);
}
int MPI_Comm_create(MPI_Comm of, MPI_Group group, MPI_Comm* made) {
  const int result = PMPI_Comm_create(of, group, made);
  return noted(result, *made);
}
int MPI_Comm_free(MPI_Comm* freed) {
  communicators().erase(*freed);
  return PMPI_Comm_free(freed);
}

int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* made) {
  const int result = PMPI_Isend(data, count, type, to, tag, comm, made);
  return noted(result, *made);
}
int MPI_Imrecv(void* data, int count, MPI_Datatype type, MPI_Message* message, MPI_Request* made) {
  const int result = PMPI_Imrecv(data, count, type, message, made);
  return noted(result, *made);
}
int MPI_Test(MPI_Request* request, int* done, MPI_Status* status) {
  const auto before = copy_of(1, request);
  const int result = PMPI_Test(request, done, status);
  forget_completed(before, request);
  return result;
}
int MPI_Wait(MPI_Request* request, MPI_Status* status) {
  const auto before = copy_of(1, request);
  const int result = PMPI_Wait(request, status);
  forget_completed(before, request);
  return result;
}
int MPI_Testsome(int count, MPI_Request* all, int* done, int* indices, MPI_Status* statuses) {
  const auto before = copy_of(count, all);
  const int result = PMPI_Testsome(count, all, done, indices, statuses);
  forget_completed(before, all);
  return result;
}
int MPI_Waitall(int count, MPI_Request* all, MPI_Status* statuses) {
  const auto before = copy_of(count, all);
  const int result = PMPI_Waitall(count, all, statuses);
  forget_completed(before, all);
  return result;
}

}  // extern "C"
