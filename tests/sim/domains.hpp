#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "decompose/decomposition.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/bounds.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::sim {

/// A small domain to be meshed in a few hundred triangles, with its decompositions made so far.
class Domain {
 public:
  /// Throws Error for a name that is not in domain_names().
  explicit Domain(const std::string& name);
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  [[nodiscard]] const Pslg& input() const { return input_; }
  [[nodiscard]] const QualityBounds& bounds() const { return bounds_; }
  [[nodiscard]] const Decomposition& cut(std::int32_t subdomains);
  /// The digest of the mesh that subdomains with presplit interfaces make independently, if none of them puts a point
  /// on an interface: no schedule can change it. Empty if some do.
  [[nodiscard]] std::optional<std::uint64_t> digest_alone(std::int32_t subdomains);

 private:
  Pslg input_;
  QualityBounds bounds_;
  std::unique_ptr<SizeField> size_;
  Triangulation mesh_;
  std::map<std::int32_t, Decomposition> cuts_;
  std::map<std::int32_t, std::optional<std::uint64_t>> digests_;
};

[[nodiscard]] const std::vector<std::string>& domain_names();

/// Made once and cached.
class Domains {
 public:
  [[nodiscard]] Domain& operator[](const std::string& name);

 private:
  std::map<std::string, std::unique_ptr<Domain>> made_;
};

}  // namespace driftmesh::sim
