#pragma once

#include <optional>

namespace driftmesh::balancer {

/// When a rank's load is worth a message: when its last report has become wrong. Between reports the others assume
/// `remaining - speed * time`, so a rank that works as reported has nothing to add.
class ReportRule {
 public:
  /// Reports are at least `gap` seconds apart and, while there is work, at most `interval` seconds. A forecast is wrong
  /// if it is off by the fraction `change` of the remaining time in the last report.
  ReportRule(double gap, double interval, double change) : gap_(gap), interval_(interval), change_(change) {}

  /// `changed`: the subdomains differ from those of the last report minus finished ones.
  [[nodiscard]] bool due(double now, double remaining, double speed, bool changed) const;
  void told(double now, double remaining, double speed) { last_ = Report{now, remaining, speed}; }

 private:
  struct Report {
    double now, remaining, speed;
  };
  [[nodiscard]] bool surprising(double elapsed, double remaining, double speed) const;

  double gap_, interval_, change_;
  std::optional<Report> last_;
};

}  // namespace driftmesh::balancer
