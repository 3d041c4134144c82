#include "runtime/crew.hpp"

namespace driftmesh {

void Shift::perform() {
  try {
    done = work->work(insertions, said);
    if (!work->state().active) done.asleep = work->rest();
  } catch (...) {
    failure = std::current_exception();
  }
}

}  // namespace driftmesh
