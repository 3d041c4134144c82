#include "runtime/crew.hpp"

namespace driftmesh {

void Shift::perform() {
  try {
    done = subdomain->work(insertions, said);
    if (subdomain->active()) return;
    if (finished != nullptr && *finished) (*finished)(*subdomain);
    if (sleep) subdomain->sleep();
  } catch (...) {
    failure = std::current_exception();
  }
}

}  // namespace driftmesh
