#pragma once

#include <cstddef>
#include <string>

#include "driftmesh/error.hpp"

namespace driftmesh {

/// For when the system gives a process fewer threads than it wants, its first one among them.
[[nodiscard]] inline LimitError too_few_threads(std::size_t given, std::size_t wanted) {
  return LimitError("the system gives this process only " + std::to_string(given) + " of " + std::to_string(wanted) +
                    " threads; use fewer, or let it have more memory (--max-memory) if that is limited");
}

}  // namespace driftmesh
