#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "base/bytes.hpp"
#include "job/team.hpp"

namespace driftmesh::job {

/// An error as it travels from the rank that met it to the others, which throw it too.
struct Failure {
  enum class Kind : std::uint8_t { kNone, kInput, kFile, kLimit, kCancelled, kOther };
  Kind kind = Kind::kNone;
  std::string message;

  void write(ByteWriter& writer) const;
  [[nodiscard]] static Failure read(ByteReader& reader);
};

/// What an exception says; null says nothing.
[[nodiscard]] Failure failure_of(const std::exception_ptr& error);

/// Throws an exception of the failure's kind.
[[noreturn]] void raise(const Failure& failure);

/// Throws on all ranks alike if one of them has failed: what the first of these met, with its number. A rank that is
/// alone throws its own exception. All ranks together; `own` is null where nothing has failed.
void agree_on_failure(Team& team, const std::exception_ptr& own);

}  // namespace driftmesh::job
