#include "api/call.hpp"

#include <string>
#include <utility>

#include "api/library_request.hpp"
#include "base/key_error.hpp"
#include "driftmesh/size_rule.hpp"
#include "job/check.hpp"
#include "job/here.hpp"
#include "sizing/described_field.hpp"

namespace driftmesh {

const SizeField* described_field(const std::function<double(const Point&)>& function) {
  if (const auto* rule = function.target<SizeRule>()) return &rule->field();
  const auto* reference = function.target<std::reference_wrapper<const SizeField>>();
  return reference == nullptr ? nullptr : dynamic_cast<const DescribedField*>(&reference->get());
}

double FunctionField::edge_length(const Point& p) const {
  const double length = function_(p);
  if (length > 0) return length;
  throw Keyed<Error>(KeyText::of(
      "{sizing.size} is {} at ({}, {}); a length must be positive everywhere in the domain, or infinity for no bound",
      length, p.x, p.y));
}

void CallerWatch::warned(const std::string& warning) {
  if (options_.warning) options_.warning(warning);
}

void CallerWatch::refining(std::int64_t triangles, double forecast) {
  if (options_.progress && !options_.progress({triangles, forecast})) throw Keyed<Cancelled>("cancelled by {progress}");
}

Call::Call(const Pslg& input, const MeshOptions& options, const balancer::PolicyMaker& policies)
    : options_(options), request_(request_of(options)), size_(options.size), watch_(options) {
  given_.input = &input;
  if (options.size) given_.size = &size_;
  if (const SizeField* described = described_field(options.size)) given_.size = described;
  const auto* rule = options.size.target<SizeRule>();
  calls_back_ = given_.size == &size_ || (rule != nullptr && rule->calls_back());
  given_.decomposition = options.subdomains.given.get();
  given_.policies = policies;
  if (const auto& own = options.balance.own) given_.policies = [own](const std::string&, const auto&) { return own; };
}

job::PlaceKind Call::place() const {
  return given_.decomposition != nullptr ? job::kSubdomains : job::place_of(request_, job::kLibrary, false);
}

std::int32_t Call::threads() const {
  const bool only_this_one = request_.run.threads == 0 && calls_back_;
  return only_this_one ? 1 : job::threads_of(request_);
}

void Call::require_step(job::Place& place, job::Refined& made, job::RunRecord& record) const {
  if (!options_.strict || options_.courant.step == 0) return;
  made.report(record);
  place.agree([&] {
    if (place.leads()) job::require_step(record);
  });
}

job::Asked Call::asked(job::PlaceKind place, const job::Request& request) const {
  if (options_.balance.own && (place & job::kMany) == 0)
    throw Keyed<Error>("{balance.own} is for many ranks, but this process is alone; remove it");
  if (options_.balance.own && options_.balance.policy != MeshOptions{}.balance.policy)
    throw Keyed<Error>("{balance.own} is given along with the name of another policy; remove one");
  return {request, job::kLibrary, given_, {.mesh = place != job::kSimulated, .whole = true}};
}

}  // namespace driftmesh
