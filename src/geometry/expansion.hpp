#pragma once

#include <cmath>

namespace driftmesh::exact {

// Arithmetic on expansions (Shewchuk 1997, section 2): a number as a sum of doubles that do not overlap,
// ordered by magnitude, smallest first. All results are exact while nothing over- or underflows; see
// predicates.hpp for the range.

/// value + error is exactly the sum, difference or product requested; value is its rounding.
struct Rounded {
  double value;
  double error;
};

[[nodiscard]] inline Rounded two_sum(double a, double b) {
  const double sum = a + b;
  const double b_seen = sum - a;
  const double a_seen = sum - b_seen;
  return {sum, (a - a_seen) + (b - b_seen)};
}

/// two_sum for |a| >= |b| or a == 0.
[[nodiscard]] inline Rounded fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// The upper 26 and the lower 26 bits (with sign) of a double: products of such halves are exact.
struct Halves {
  double upper;
  double lower;
};

[[nodiscard]] inline Halves split(double a) {
  const double shifted = 0x1.0000002p27 * a;
  const double upper = shifted - (shifted - a);
  return {upper, a - upper};
}

/// The product by Dekker's and Veltkamp's method. Not std::fma: where the target has no such instruction it
/// is a library call of tens of nanoseconds.
[[nodiscard]] inline Rounded two_product(double a, const Halves& a_half, double b, const Halves& b_half) {
  const double product = a * b;
  const double rest = product - a_half.upper * b_half.upper - a_half.lower * b_half.upper - a_half.upper * b_half.lower;
  return {product, a_half.lower * b_half.lower - rest};
}

/// An expansion of at most Capacity terms on the stack. Holds no zero term: zero is the expansion without
/// terms.
template <int Capacity>
struct Expansion {
  int size = 0;
  double term[Capacity];

  void append(double t) {
    term[size] = t;
    size += t != 0;
  }
  /// The largest term: it has the sign of the whole, and differs from it by less than an ulp. 0 for zero.
  [[nodiscard]] double leading() const { return size == 0 ? 0.0 : term[size - 1]; }
};

template <int M>
[[nodiscard]] Expansion<M> operator-(const Expansion<M>& e) {
  Expansion<M> h;
  h.size = e.size;
  for (int i = 0; i < e.size; ++i) h.term[i] = -e.term[i];
  return h;
}

/// Terms of both merged by magnitude and accumulated from the smallest.
template <int M, int N>
[[nodiscard]] Expansion<M + N> operator+(const Expansion<M>& e, const Expansion<N>& f) {
  Expansion<M + N> h;
  double carry = 0;
  for (int i = 0, j = 0; i < e.size || j < f.size;) {
    const bool from_e = j == f.size || (i < e.size && std::fabs(e.term[i]) < std::fabs(f.term[j]));
    const Rounded sum = two_sum(carry, from_e ? e.term[i++] : f.term[j++]);
    h.append(sum.error);
    carry = sum.value;
  }
  h.append(carry);
  return h;
}

template <int M, int N>
[[nodiscard]] Expansion<M + N> operator-(const Expansion<M>& e, const Expansion<N>& f) {
  return e + (-f);
}

template <int M>
[[nodiscard]] Expansion<2 * M> operator*(const Expansion<M>& e, double b) {
  Expansion<2 * M> h;
  const Halves b_half = split(b);
  double carry = 0;
  for (int i = 0; i < e.size; ++i) {
    const Rounded product = two_product(e.term[i], split(e.term[i]), b, b_half);
    const Rounded low = two_sum(carry, product.error);
    const Rounded high = fast_two_sum(product.value, low.value);
    h.append(low.error);
    h.append(high.error);
    carry = high.value;
  }
  h.append(carry);
  return h;
}

[[nodiscard]] inline Expansion<2> product(double a, double b) {
  const Rounded p = two_product(a, split(a), b, split(b));
  Expansion<2> h;
  h.append(p.error);
  h.append(p.value);
  return h;
}

/// a * d - b * c.
[[nodiscard]] inline Expansion<4> determinant(double a, double b, double c, double d) {
  return product(a, d) - product(b, c);
}

}  // namespace driftmesh::exact
