#include "cluster/replay/counted_work.hpp"

#include <algorithm>
#include <cmath>

#include "base/bytes.hpp"
#include "protocol/packed_size.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh {

WorkState CountedWork::state() const {
  constexpr std::uint64_t kOverhead = 40;
  const bool finished = count_.done >= count_.work;
  return {.active = !finished,
          .started = count_.done > 0,
          .refined = finished,
          .triangles = std::llround(count_.done),
          .predicted = count_.forecast,
          .forecast = count_.forecast,
          .remaining = finished ? 0 : std::max(1.0, count_.forecast - count_.done),
          .packed_bytes = kOverhead + static_cast<std::uint64_t>(protocol::kBytesPerTriangle * count_.done)};
}

SliceWork CountedWork::work(std::int64_t insertions, std::vector<SplitPoint<GlobalRootId>>&) {
  SliceWork slice{.begun = count_.done <= 0};
  const double amount = std::min(kTrianglesPerPoint * static_cast<double>(insertions), count_.work - count_.done);
  slice.triangles = -std::llround(count_.done);
  count_.done += amount;
  slice.triangles += std::llround(count_.done);
  slice.seconds = amount * seconds_;
  return slice;
}

Bytes CountedWork::pack() const {
  ByteWriter writer;
  writer.value(id());
  writer.value(count_);
  Bytes packed = writer.take();
  packed.resize(std::max(packed.size(), static_cast<std::size_t>(state().packed_bytes)));
  return packed;
}

CountedWork CountedWork::unpack(std::span<const std::byte> packed, double seconds) {
  ByteReader reader(packed);
  const auto id = reader.value<SubdomainId>();
  return {id, reader.value<Count>(), seconds};
}

}  // namespace driftmesh
