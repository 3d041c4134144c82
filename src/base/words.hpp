#pragma once

#include <cstdint>
#include <string>

namespace driftmesh {

/// 1234567 -> "1,234,567"
[[nodiscard]] std::string grouped(std::int64_t n);
/// Bytes in decimal units: "812 B", "43.9 kB", "1.53 GB"
[[nodiscard]] std::string bytes_words(std::uint64_t bytes);
/// "0.042 s", "12.3 s", "3 min 20 s", "2 h 05 min"
[[nodiscard]] std::string duration_words(double seconds);
/// Whole seconds, rounded up: "3 s", "3 min 20 s", "2 h 05 min"
[[nodiscard]] std::string whole_seconds_words(double seconds);
/// A count known to about three digits: "12,300,000", "4.1e+15"
[[nodiscard]] std::string estimate_words(double count);
/// A number per second: "850 thousand", "5.31 million"
[[nodiscard]] std::string rate_words(double per_second);

}  // namespace driftmesh
