#pragma once

#include <optional>

namespace driftmesh::balancer {

/// When a rank's load is worth a message: when those who know the last report are wrong about it. Between reports they
/// reckon with `remaining - speed * time`, so a rank that works as it said has nothing to tell.
class ReportRule {
 public:
  /// Reports come at least `gap` seconds after each other, and while there is work at most `interval` seconds. A
  /// forecast is wrong when it is off by the share `change` of the time that the last report said is left.
  ReportRule(double gap, double interval, double change) : gap_(gap), interval_(interval), change_(change) {}

  /// `changed`: other subdomains than those of the last report, less what was finished.
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
