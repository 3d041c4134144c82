#include "sizing/exact_field.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace driftmesh {

ExactField::ExactField(std::shared_ptr<const SizeField> field, std::shared_ptr<const PlaneFunction> function,
                       std::shared_ptr<const BackgroundFunction> background, const Box& domain)
    : field_(std::move(field)),
      function_(std::move(function)),
      background_(std::move(background)),
      domain_(domain),
      cells_(std::size_t{kCells} * std::size_t{kCells}) {}

double ExactField::edge_length(const Point& p) const {
  const double length = function_at(p).at(p);
  return length > 0 || field_ == nullptr ? length : field_->edge_length(p);
}

void ExactField::visit_marks(const std::function<void(const Point&)>& visit) const {
  if (background_ != nullptr) background_->visit_marks(visit);
}

const PlaneFunction& ExactField::function_at(const Point& p) const {
  const Point& low = domain_.low;
  const double width = (domain_.high.x - low.x) / kCells, height = (domain_.high.y - low.y) / kCells;
  if (!domain_.contains(p) || !(width > 0 && height > 0)) return *function_;
  const int i = std::min(static_cast<int>((p.x - low.x) / width), kCells - 1);
  const int j = std::min(static_cast<int>((p.y - low.y) / height), kCells - 1);
  Cell& cell = cells_[static_cast<std::size_t>(j) * kCells + static_cast<std::size_t>(i)];
  std::call_once(cell.is_made, [&] {
    // A bit wider, for points that rounding puts into the next cell.
    const double margin = (width + height) / 1024;
    cell.function = function_->within(Box::around({low.x + i * width, low.y + j * height},
                                                  {low.x + (i + 1) * width, low.y + (j + 1) * height}, margin));
  });
  return cell.function != nullptr ? *cell.function : *function_;
}

}  // namespace driftmesh
