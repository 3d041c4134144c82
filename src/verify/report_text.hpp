#pragma once

#include <string>

#include "verify/verify.hpp"

namespace driftmesh {

/// A report for human readers: counts, areas, a histogram of angles, exceptions by cause and flaws by kind with the
/// first few of each. Lines end in '\n'. The verdict is not included.
[[nodiscard]] std::string report_text(const VerifyReport& report, const VerifyOptions& options);

/// One line without '\n': "accepted: ..." with what was checked, or "rejected: ..." with the flaws and their counts.
[[nodiscard]] std::string verdict_text(const VerifyReport& report, const VerifyOptions& options);

}  // namespace driftmesh
