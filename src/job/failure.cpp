#include "job/failure.hpp"

#include <new>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "job/limits.hpp"

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

/// Of all ranks' failures the one that is thrown.
Failure first_of(const std::vector<Bytes>& failures) {
  for (const Rank rank : first_ids<Rank>(failures.size())) {
    Failure failure = failure_in(failures[to_index(rank)]);
    if (failure.kind == Failure::Kind::kNone) continue;
    failure.message = "rank " + to_string(rank) + ": " + failure.message;
    return failure;
  }
  return {};
}

}  // namespace

void Failure::write(ByteWriter& writer) const {
  writer.value(kind);
  writer.text(message);
}

Failure Failure::read(ByteReader& reader) {
  Failure failure;
  reader.value(failure.kind);
  failure.message = reader.text();
  return failure;
}

Failure failure_of(const std::exception_ptr& error) {
  if (!error) return {};
  try {
    std::rethrow_exception(error);
  } catch (const InputError& e) {
    return {Failure::Kind::kInput, e.what()};
  } catch (const FileError& e) {
    return {Failure::Kind::kFile, e.what()};
  } catch (const LimitError& e) {
    return {Failure::Kind::kLimit, e.what()};
  } catch (const std::bad_alloc&) {
    return {Failure::Kind::kLimit, kOutOfMemory};
  } catch (const Cancelled& e) {
    return {Failure::Kind::kCancelled, e.what()};
  } catch (const std::exception& e) {
    return {Failure::Kind::kOther, e.what()};
  }
}

void raise(const Failure& failure) {
  switch (failure.kind) {
    case Failure::Kind::kInput:
      throw InputError(failure.message);
    case Failure::Kind::kFile:
      throw FileError(failure.message);
    case Failure::Kind::kLimit:
      throw LimitError(failure.message);
    case Failure::Kind::kCancelled:
      throw Cancelled(failure.message);
    default:
      throw Error(failure.message);
  }
}

void agree_on_failure(Team& team, const std::exception_ptr& own) {
  if (team.alone() && own) std::rethrow_exception(own);
  if (team.alone()) return;
  const std::vector<Bytes> failures = team.gather(bytes_of(failure_of(own)));
  const Failure first = failure_in(team.broadcast(team.leads() ? bytes_of(first_of(failures)) : Bytes()));
  if (first.kind != Failure::Kind::kNone) raise(first);
}

}  // namespace driftmesh::job
