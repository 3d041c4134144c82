#include "base/failure.hpp"

#include <new>

#include "base/key_error.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

void Failure::write(ByteWriter& writer) const {
  writer.value(kind);
  writer.text(message);
  writer.text(key);
  writer.text(next);
}

Failure Failure::read(ByteReader& reader) {
  Failure failure;
  reader.value(failure.kind);
  failure.message = reader.text();
  failure.key = reader.text();
  failure.next = reader.text();
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
  } catch (const KeyError& e) {
    return {Failure::Kind::kKey, e.problem(), e.key(), e.next()};
  } catch (const std::exception& e) {
    return {Failure::Kind::kOther, e.what()};
  }
}

Failure met_by(Rank rank, Failure failure) {
  if (failure.kind != Failure::Kind::kNothing && failure.kind != Failure::Kind::kKey)
    failure.message.insert(0, "rank " + to_string(rank) + ": ");
  return failure;
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
    case Failure::Kind::kKey:
      throw KeyError(failure.key, failure.message, failure.next);
    default:
      throw Error(failure.message);
  }
}

}  // namespace driftmesh
