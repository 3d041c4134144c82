#include "base/failure.hpp"

#include <new>

#include "base/key_error.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

void Failure::write(ByteWriter& writer) const {
  writer.value(kind);
  message.write(writer);
  writer.text(key);
  next.write(writer);
}

Failure Failure::read(ByteReader& reader) {
  Failure failure;
  reader.value(failure.kind);
  failure.message = KeyText::read(reader);
  failure.key = reader.text();
  failure.next = KeyText::read(reader);
  return failure;
}

Failure failure_of(const std::exception_ptr& error) {
  if (!error) return {};
  try {
    std::rethrow_exception(error);
  } catch (const InputError& e) {
    return {Failure::Kind::kInput, text_of(e)};
  } catch (const FileError& e) {
    return {Failure::Kind::kFile, text_of(e)};
  } catch (const LimitError& e) {
    return {Failure::Kind::kLimit, text_of(e)};
  } catch (const std::bad_alloc&) {
    return {Failure::Kind::kLimit, out_of_memory()};
  } catch (const Cancelled& e) {
    return {Failure::Kind::kCancelled, text_of(e)};
  } catch (const KeyError& e) {
    return {Failure::Kind::kKey, e.problem(), e.key(), e.next()};
  } catch (const std::exception& e) {
    return {Failure::Kind::kOther, text_of(e)};
  } catch (...) {
    return {Failure::Kind::kOther, "something was thrown that is no std::exception"};
  }
}

KeyText text_of(const Failure& failure) {
  if (failure.kind != Failure::Kind::kKey) return failure.message;
  return KeyError(failure.key, failure.message, failure.next).text();
}

Failure met_by(Rank rank, Failure failure) {
  if (failure.kind != Failure::Kind::kNothing && failure.kind != Failure::Kind::kKey)
    failure.message = KeyText::of("rank {}: {}", to_string(rank), failure.message);
  return failure;
}

void raise(const Failure& failure) {
  switch (failure.kind) {
    case Failure::Kind::kInput:
      throw Keyed<InputError>(failure.message);
    case Failure::Kind::kFile:
      throw Keyed<FileError>(failure.message);
    case Failure::Kind::kLimit:
      throw Keyed<LimitError>(failure.message);
    case Failure::Kind::kCancelled:
      throw Keyed<Cancelled>(failure.message);
    case Failure::Kind::kKey:
      throw KeyError(failure.key, failure.message, failure.next);
    default:
      throw Keyed<Error>(failure.message);
  }
}

}  // namespace driftmesh
