#pragma once

#include <iostream>
#include <string>

#include "job/watch.hpp"

namespace driftmesh::app {

/// Prints repairs and warnings unless quiet.
class RepairView final : public job::Watch {
 public:
  explicit RepairView(bool quiet) : quiet_(quiet) {}
  void repaired(const RepairReport& repairs) override {
    if (!quiet_) std::cerr << repairs.summary();
  }
  void warned(const std::string& warning) override {
    if (!quiet_) std::cerr << "warning: " << warning << '\n';
  }

 private:
  bool quiet_;
};

}  // namespace driftmesh::app
