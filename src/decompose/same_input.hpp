#pragma once

#include <cstdint>
#include <string>

#include "decompose/decomposition.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh {

/// Of all in a (repaired) input that its decompositions depend on, but for bounds: another input has another one, but
/// for a chance of 2^-31.
[[nodiscard]] std::int32_t input_digest(const Pslg& input);

/// Throws the InputError, naming `file`, that says that a decomposition does not belong to an input. `why` goes on from
/// "made from another input".
[[noreturn]] void refuse_as_another(const std::string& file, const std::string& why);

/// Throws InputError, naming `file`, unless the decomposition's points, segments and regions are those of this
/// (repaired) input. For decompositions in memory, which carry no digest of their input: a segment that the input has
/// and the decomposition has not goes unnoticed.
void require_same_input(const Decomposition& decomposition, const Pslg& input, const std::string& file);

}  // namespace driftmesh
