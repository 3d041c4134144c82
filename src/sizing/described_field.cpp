#include "sizing/described_field.hpp"

namespace driftmesh {

double DescribedField::edge_length(const Point& p) const {
  std::call_once(is_made_, [this] {
    SizingOptions options = asked_;
    options.exact = true;
    by_itself_ = make_size_field(options);
  });
  return by_itself_->edge_length(p);
}

}  // namespace driftmesh
