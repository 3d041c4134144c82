#pragma once

#include <cstdint>
#include <string>

#include "decompose/decomposition.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// A digest of everything in a (repaired) input that decompositions depend on, except bounds: different inputs have
/// different digests with a probability of 1 - 2^-31.
[[nodiscard]] std::int32_t input_digest(const Pslg& input);

/// Throws the InputError, naming `file`, for a decomposition that does not belong to an input. `why` continues "made
/// from another input".
[[noreturn]] void refuse_as_another(const std::string& file, const std::string& why);

/// Throws InputError, naming `file`, unless the decomposition's points, segments and regions are those of this
/// (repaired) input. For decompositions in memory, which carry no digest of their input: segments of the input that the
/// decomposition lacks go unnoticed.
void require_same_input(const Decomposition& decomposition, const Pslg& input, const std::string& file);

}  // namespace driftmesh
