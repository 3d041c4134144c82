#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>

namespace driftmesh::bench {

/// Runs `fill(buffer)` in a forked child and copies the `size` bytes of its buffer back. A run in a separate process
/// starts with a fresh heap and has its own memory peak. Throws Error if the child fails.
void run_in_child(const std::function<void(void*)>& fill, void* result, std::size_t size);

/// The same, for a function that returns plain data.
template <class Function>
auto in_child(const Function& function) {
  using Result = std::invoke_result_t<Function>;
  static_assert(std::is_trivially_copyable_v<Result>);
  Result result{};
  run_in_child([&](void* buffer) { *static_cast<Result*>(buffer) = function(); }, &result, sizeof result);
  return result;
}

/// The peak memory of this process so far (VmHWM), in bytes; 0 if unknown.
[[nodiscard]] std::int64_t peak_memory();

}  // namespace driftmesh::bench
