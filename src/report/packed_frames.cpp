#include "report/packed_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/xml_text.hpp"

namespace driftmesh {

PackedFrames::PackedFrames(std::string name, std::string field, bool at_points)
    : name_(std::move(name)), field_(std::move(field)), at_points_(at_points) {}

void PackedFrames::add(const Mesh& mesh, const std::vector<double>& values, std::optional<double> time) {
  if (frames_ == 0 || mesh.points != points_ || mesh.triangles != corners_) add_mesh(mesh);
  std::vector<float> shown;
  shown.reserve(values.size());
  for (const double value : values) {
    shown.push_back(static_cast<float>(value));
    if (!std::isfinite(shown.back())) continue;
    least_ = std::min(least_, shown.back());
    most_ = std::max(most_, shown.back());
  }
  add_array(packed_,
            fmt::format("data-frame=\"values\" data-of=\"{}\"{}", meshes_ - 1,
                        time ? fmt::format(" data-time=\"{}\"", *time) : ""),
            shown);
  ++frames_;
  triangles_ += mesh.triangles.size();
}

void PackedFrames::add_mesh(const Mesh& mesh) {
  points_ = mesh.points;
  corners_ = mesh.triangles;
  const Corners own = corners_of(points_);
  if (meshes_ == 0) {
    box_ = own;
    middle_ = middle_of(own);
  }
  box_ = {{std::min(box_.low.x, own.low.x), std::min(box_.low.y, own.low.y)},
          {std::max(box_.high.x, own.high.x), std::max(box_.high.y, own.high.y)}};
  add_array(packed_, "data-frame=\"points\"", near_the_middle(points_, middle_));
  std::vector<std::int32_t> numbers;
  numbers.reserve(3 * corners_.size());
  for (const auto& t : corners_) numbers.insert(numbers.end(), t.begin(), t.end());
  add_array(packed_, "data-frame=\"triangles\"", numbers);
  ++meshes_;
}

std::string PackedFrames::blocks() const {
  if (frames_ == 0) return {};
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  const bool has_values = least_ <= most_;
  const std::vector<float> box = near_the_middle({box_.low, box_.high}, middle_);
  return fmt::format(
             "<script type=\"text/plain\" data-series=\"{}\" data-field=\"{}\" data-at=\"{}\" data-middle=\"{} {}\" "
             "data-box=\"{}\" data-range=\"{} {}\"></script>\n",
             escaped(name_), escaped(field_), at_points_ ? "points" : "triangles", middle_.x, middle_.y,
             fmt::join(box, " "), has_values ? least_ : kNothing, has_values ? most_ : kNothing) +
         packed_;
}

}  // namespace driftmesh
