#pragma once

#include <cstddef>

#include "base/key_error.hpp"

namespace driftmesh {

/// For when the system gives a process fewer threads than it wants, its first one among them.
[[nodiscard]] inline Keyed<LimitError> too_few_threads(std::size_t given, std::size_t wanted) {
  return Keyed<LimitError>(
      KeyText::of("the system gives this process only {} of {} threads; use fewer, or let it have more memory "
                  "({limits.max-memory}) if that is limited",
                  given, wanted));
}

}  // namespace driftmesh
