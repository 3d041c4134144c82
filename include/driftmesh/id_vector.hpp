#pragma once

#include <concepts>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

// IDs, and arrays indexed by them. An ID is a scoped enumeration where distinct types pay off
// (`enum class Rank : std::int32_t {}`), otherwise a plain integer.
namespace driftmesh {

template <class Id>
concept IsId = std::integral<Id> || std::is_enum_v<Id>;

/// The ID as a plain integer, for arithmetic, text and serialization.
template <IsId Id>
[[nodiscard]] constexpr auto to_int(Id id) {
  if constexpr (std::is_enum_v<Id>)
    return static_cast<std::underlying_type_t<Id>>(id);
  else
    return id;
}

/// In builds with assertions: aborts if an array has no element with this ID.
inline void check_id([[maybe_unused]] bool known) {
#ifdef DRIFTMESH_CHECKED
  if (known) return;
  std::fputs("driftmesh: no array element has this ID\n", stderr);
  std::abort();
#endif
}

/// The array index of an ID. Negative IDs are beyond the end of every array.
template <IsId Id>
[[nodiscard]] constexpr std::size_t to_index(Id id) {
  return static_cast<std::size_t>(id);
}

template <class Id>
concept IsSignedId = IsId<Id> && static_cast<Id>(-1) < static_cast<Id>(0);

/// The null ID: -1 in any signed ID type.
struct NoId {
  template <IsSignedId Id>
  [[nodiscard]] constexpr operator Id() const {
    return static_cast<Id>(-1);
  }
  template <IsSignedId Id>
  [[nodiscard]] friend constexpr bool operator==(Id id, NoId) {
    return id == static_cast<Id>(-1);
  }
};
inline constexpr NoId kNone;

/// The IDs 0 .. count - 1, for iteration.
template <IsId Id>
class IdRange {
 public:
  class Iterator {
   public:
    using value_type = Id;
    using difference_type = std::ptrdiff_t;
    using pointer = const Id*;
    using reference = Id;
    using iterator_category = std::input_iterator_tag;

    Iterator() = default;
    constexpr explicit Iterator(std::size_t index) : index_(index) {}
    [[nodiscard]] constexpr Id operator*() const { return static_cast<Id>(index_); }
    constexpr Iterator& operator++() {
      ++index_;
      return *this;
    }
    constexpr Iterator operator++(int) { return Iterator(index_++); }
    friend constexpr bool operator==(Iterator, Iterator) = default;

   private:
    std::size_t index_ = 0;
  };
  constexpr explicit IdRange(std::size_t count) : count_(count) {}
  [[nodiscard]] constexpr Iterator begin() const { return Iterator(0); }
  [[nodiscard]] constexpr Iterator end() const { return Iterator(count_); }

 private:
  std::size_t count_;
};

/// The first `count` IDs, count >= 0: for (const Rank r : first_ids<Rank>(ranks)).
template <IsId Id>
[[nodiscard]] constexpr IdRange<Id> first_ids(std::integral auto count) {
  return IdRange<Id>(static_cast<std::size_t>(count));
}

/// A std::vector indexed only by IDs of type Id.
///
/// \code
/// enum class Host : std::int32_t {};
/// driftmesh::IdVector<Host, double> load(4, 1.0);
/// load[Host{2}] = 5;
/// for (const Host h : driftmesh::ids_of(load)) std::cout << driftmesh::to_int(h) << ": " << load[h] << '\n';
/// \endcode
template <IsId Id, class T>
class IdVector : public std::vector<T> {
  using Base = std::vector<T>;

 public:
  using Base::Base;
  IdVector() = default;
  explicit IdVector(Base values) : Base(std::move(values)) {}

  /// Whether there is an element with this ID.
  [[nodiscard]] bool has(Id id) const { return to_index(id) < this->size(); }
  /// The ID of the next element to be appended.
  [[nodiscard]] Id next_id() const { return static_cast<Id>(this->size()); }

  [[nodiscard]] typename Base::reference operator[](Id id) {
    check_id(has(id));
    return Base::operator[](to_index(id));
  }
  [[nodiscard]] typename Base::const_reference operator[](Id id) const {
    check_id(has(id));
    return Base::operator[](to_index(id));
  }
  [[nodiscard]] typename Base::reference at(Id id) { return Base::at(to_index(id)); }
  [[nodiscard]] typename Base::const_reference at(Id id) const { return Base::at(to_index(id)); }
};

/// A std::span indexed only by IDs of type Id.
template <IsId Id, class T>
class IdSpan : public std::span<T> {
  using Base = std::span<T>;
  using Vector = IdVector<Id, std::remove_const_t<T>>;

 public:
  IdSpan() = default;
  explicit IdSpan(Base values) : Base(values) {}
  IdSpan(std::conditional_t<std::is_const_v<T>, const Vector, Vector>& values) : Base(values) {}

  [[nodiscard]] bool has(Id id) const { return to_index(id) < this->size(); }
  [[nodiscard]] T& operator[](Id id) const {
    check_id(has(id));
    return Base::operator[](to_index(id));
  }
};

/// The IDs of all elements.
template <IsId Id, class T>
[[nodiscard]] IdRange<Id> ids_of(const IdVector<Id, T>& values) {
  return IdRange<Id>(values.size());
}
template <IsId Id, class T>
[[nodiscard]] IdRange<Id> ids_of(IdSpan<Id, T> values) {
  return IdRange<Id>(values.size());
}

}  // namespace driftmesh
