#include "verify/verify.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/in_turns.hpp"
#include "driftmesh/error.hpp"
#include "mesh/merge_pieces.hpp"
#include "verify/chains.hpp"
#include "verify/corner_table.hpp"
#include "verify/domain.hpp"
#include "verify/domain_check.hpp"
#include "verify/duplicates.hpp"
#include "verify/frame.hpp"
#include "verify/judge.hpp"
#include "verify/local_check.hpp"
#include "verify/piece_check.hpp"
#include "verify/piece_numbers.hpp"
#include "verify/point_data_check.hpp"
#include "verify/point_index.hpp"
#include "verify/polygons_check.hpp"
#include "verify/regions.hpp"
#include "verify/size_check.hpp"
#include "verify/step_check.hpp"
#include "verify/subsegments.hpp"

namespace driftmesh {
namespace {

void require_numbers(const Mesh& piece, std::size_t k) {
  if (piece.numbers.size() != piece.points.size())
    throw Error("piece " + std::to_string(k) + " does not say which numbers its points have in the whole mesh");
  for (const std::int64_t number : piece.numbers)
    if (number < 0) throw Error("piece " + std::to_string(k) + " has a point of number " + std::to_string(number));
}

/// One verification: its phases in order, and what later ones need from earlier ones.
class Verification {
 public:
  Verification(const Pieces& pieces, bool whole, const Pslg* input, const VerifyOptions& options)
      : pieces_(pieces), whole_(whole), input_(input), options_(options), findings_(options.max_listed) {}

  VerifyReport run() {
    find_domain();
    check_pieces();
    if (options_.depth != nullptr) check_step();
    join_pieces();
    if (computable_) {
      if (conflict_) findings_.add(Flaw::kInputNotPlanar, [&] { return *conflict_; });
      check_triangulation();
      check_against_domain();
      check_channels();
      list_duplicates();
    }
    report_.findings = std::move(findings_);
    return std::move(report_);
  }

 private:
  // ---- The pieces ----------------------------------------------------------------------------------------------

  void find_domain() {
    if (input_ == nullptr) return;
    domain_.emplace(*input_, options_.holes);
    conflict_ = domain_->conflict();
    if (conflict_) return domain_.reset();
    corners_.emplace(domain_->points());
    for (const std::int32_t p : first_ids<std::int32_t>(domain_->points().size())) corners_->add(p);
    has_regions_ = domain_->has_regions();
  }

  void check_pieces() {
    if (options_.size != nullptr)
      size_.emplace(*options_.size, options_.size_spacing, largest_triangle(),
                    options_.size_is_compiled ? SizeCheck::kTolerated : 1);
    bounds_ = {options_.min_angle, options_.plain, {}, size_ ? &*size_ : nullptr};
    check_all_pieces();
    if (whole_) return;
    shared_ = PieceNumbers(found_).shared();
    if (!shared_.empty()) check_all_pieces();
  }

  [[nodiscard]] double largest_triangle() const {
    return domain_ ? domain_->area() : std::numeric_limits<double>::infinity();
  }

  void check_all_pieces() {
    found_ = std::vector<PieceReport>(pieces_.count);
    for_each_piece([&](const NamedMesh& piece, std::size_t k) {
      found_[k] = check_piece(piece, order());
      if (!whole_) found_[k].parts.reset();
    });
  }

  [[nodiscard]] PieceOrder order() const {
    return {.corners = corners_ ? &*corners_ : nullptr,
            .shared = shared_,
            .bounds = has_regions_ ? nullptr : &bounds_,
            .parts = has_regions_,
            .delaunay = delaunay(),
            .max_listed = options_.max_listed,
            .threads = whole_ ? threads() : 1};
  }

  [[nodiscard]] DelaunayRule delaunay() const { return {options_.check_delaunay, options_.delaunay_slack}; }

  template <class Work>
  void for_each_piece(const Work& work) const {
    in_turns(pieces_.count, threads(),
             [&](std::size_t k) { with_piece(k, [&](const NamedMesh& piece) { work(piece, k); }); });
  }

  template <class Work>
  void with_piece(std::size_t k, const Work& work) const {
    pieces_.with_piece(k, [&](const Mesh& piece) {
      if (whole_) return work(NamedMesh(piece));
      require_numbers(piece, k);
      work(NamedMesh(piece, static_cast<std::int32_t>(k)));
    });
  }

  [[nodiscard]] std::size_t threads() const { return std::max<std::size_t>(options_.threads, 1); }

  void check_step() {
    step_.emplace(options_.courant, *options_.depth);
    std::vector<StepMeasures> measures(pieces_.count);
    for_each_piece([&](const NamedMesh& piece, std::size_t k) {
      if (found_[k].computable) measures[k] = step_->measure(piece, options_.max_listed, whole_ ? threads() : 1);
    });
    for (const StepMeasures& piece : measures) report_.step.add(piece, options_.max_listed);
    if (!options_.strict_step) return;
    for (std::uint64_t i = 0; i < report_.step.above; ++i)
      findings_.add(Flaw::kTimeStep, [&] { return i < report_.step.worst.size() ? report_.step.worst[i].words : ""; });
  }

  // ---- The whole -----------------------------------------------------------------------------------------------

  void join_pieces() {
    std::set<std::int32_t> subdomains;
    for (PieceReport& piece : found_) {
      findings_.append(piece.findings);
      computable_ = computable_ && piece.computable;
      report_.triangles += piece.triangles;
      report_.points += piece.points;
      used_points_ += piece.used_inside;
      subdomains.merge(piece.subdomains);
      interfaces_.add(piece.interfaces);
    }
    report_.subdomains = subdomains.size();
    report_.subsegments_listed = report_.triangles == 0 || std::ranges::any_of(found_, [](const PieceReport& piece) {
                                   return piece.has_subsegments;
                                 });
    report_.pieces = whole_ ? 0 : pieces_.count;
    if (computable_) make_frame();
    report_.unused_points = report_.points - used_points_;
  }

  void make_frame() {
    if (whole_)
      frame_ = std::move(found_[0].frame);
    else
      join_frames_of_pieces();
    report_.subsegments = frame_.mesh.edges.size();
    Findings of_arrays(options_.max_listed);  // points whose numbers are the same become one
    computable_ = check_arrays(frame_.named(), of_arrays);
    findings_.append(of_arrays);
    if (!computable_) return;
    table_.emplace(frame_.mesh);
    index_.emplace(frame_.mesh.points);
    const auto counts = [&](std::int32_t v) { return frame_.marks[v] != 0 && table_->used(v); };
    for (const std::int32_t v : frame_.marked()) used_points_ += counts(v) ? 1 : 0;
    check_duplicates(
        frame_.named(), counts, [](std::int32_t) { return true; }, *index_, findings_);
  }

  void join_frames_of_pieces() {
    const PieceNumbers numbers(found_);
    report_.points = numbers.points();
    numbers.check_largest(findings_);
    std::vector<Frame> frames;
    for (PieceReport& piece : found_) frames.push_back(std::move(piece.frame));
    MergeFaults faults;
    frame_ = join_frames(frames, faults);
    for (std::size_t i = 0; i < faults.count; ++i)
      findings_.add(Flaw::kPiecesDisagree, [&] { return i < faults.first.size() ? faults.first[i] : "..."; });
    numbers.check_gaps(findings_);
  }

  void check_triangulation() {
    const std::vector<std::int32_t> hubs = frame_.marked();
    subsegments_.emplace(frame_.mesh.points.size(),
                         report_.subsegments_listed ? frame_.mesh.edges : boundary_edges(frame_.mesh, *table_, hubs));
    if (has_regions_) parts_.emplace(parts_of_frame(frame_));
    FanCheck fans(frame_.named(), *table_, *subsegments_, delaunay(), options_.max_listed);
    fans.check(hubs, parts_ ? &*parts_ : nullptr);
    findings_.append(fans.findings());
    findings_.append(fans.edges().findings());
    check_subsegments(frame_.named(), *subsegments_, findings_);
    check_embedding(frame_.named(), fans.boundary(), findings_);
    report_.boundary_edges = fans.boundary().size();
    interfaces_.add(fans.edges().interfaces());
    note_interfaces();
  }

  void note_interfaces() {
    report_.interfaces = interfaces_.subdomains.size();
    report_.interface_edges = interfaces_.edges;
    report_.interface_edges_not_delaunay = interfaces_.not_delaunay;
    report_.rank_interface_edges = interfaces_.between_ranks;
  }

  void check_against_domain() {
    const Chains chains = make_chains();
    if (!domain_) return take_quality(chains);
    DomainCheck against(frame_.named(), *domain_, *index_, chains, findings_);
    against.check_points();
    check_point_data(frame_.named(), *input_, *index_, findings_);
    against.check_chains();
    against.check_euler(static_cast<std::int64_t>(report_.triangles), static_cast<std::int64_t>(used_points_),
                        static_cast<std::int64_t>(report_.boundary_edges));
    check_given(against);
    if (has_regions_) faces_.emplace(frame_, against.find_faces(*parts_));
    take_quality(chains);
    against.check_area(report_.area);
    report_.against_input = true;
    report_.input_area = domain_->area();
  }

  /// Seeds and holes would need the segments that repair leaves.
  void check_given(const DomainCheck& against) {
    if (options_.given == nullptr || input_->polygons.empty() || same_polygons(*options_.given, *input_)) return;
    if (options_.holes == HoleRule::kPoints && input_->holes.empty() && !has_seeds(*input_))
      report_.polygons_judged =
          check_polygons(*options_.given, *domain_, against.find_places(), options_.moved, findings_);
  }

  [[nodiscard]] Chains make_chains() const {
    const Mesh& mesh = frame_.mesh;
    if (!domain_) return {mesh, *subsegments_, [&](std::int32_t v) { return bends_at(mesh, *subsegments_, v); }};
    const std::vector<char> corner = DomainCheck::find_corners(mesh, *domain_, *index_);
    return {mesh, *subsegments_, [&](std::int32_t v) { return corner[v] != 0; }};
  }

  // ---- The pieces once more ------------------------------------------------------------------------------------

  /// What was found in a piece on the second look.
  struct Second {
    Findings regions, bounds;
    Quality exceptions;
    bool regions_listed = true;
  };

  void take_quality(const Chains& chains) {
    std::vector<Second> second(pieces_.count, {Findings(options_.max_listed), Findings(options_.max_listed), {}});
    in_turns(pieces_.count, threads(), [&](std::size_t k) { look_again(k, chains, second[k]); });
    Measures measures;
    for (const PieceReport& piece : found_) measures.add(piece.measures);
    report_.quality = measures.quality();
    report_.area = report_.quality.total_area;
    report_.regions_listed = std::ranges::all_of(second, &Second::regions_listed);
    for (const Second& piece : second) {
      if (report_.regions_listed) findings_.append(piece.regions);
      findings_.append(piece.bounds);
      report_.quality.add_exceptions(piece.exceptions, options_.max_listed);
    }
  }

  /// Judges the suspects. The piece itself is needed only if there are too many of them, or regions: their triangles
  /// are measured now that it is known which region they lie in.
  void look_again(std::size_t k, const Chains& chains, Second& found) {
    Judge judge(frame_.mesh, chains, options_.min_angle, options_.max_listed, step_ ? &*step_ : nullptr);
    const auto take = [&](const Suspect& suspect) { judge.judge(suspect, found.exceptions, found.bounds); };
    Measures& measures = found_[k].measures;
    if (faces_ || !measures.all_suspects)
      with_piece(k, [&](const NamedMesh& piece) {
        const std::vector<std::int32_t> faces = faces_of(piece, k);
        const CheckedBounds bounds = bounds_in(faces);
        if (faces_) check_regions(piece, faces, found);
        if (faces_) measures = measure(piece, bounds, whole_ ? threads() : 1);
        if (!measures.all_suspects) find_suspects(piece, bounds, take);
      });
    for (const Suspect& suspect : measures.suspects) take(suspect);
    measures.suspects = {};
  }

  void check_regions(const NamedMesh& piece, const std::vector<std::int32_t>& faces, Second& found) const {
    found.regions_listed = piece.mesh().regions.size() == faces.size();
    if (found.regions_listed) driftmesh::check_regions(piece, *domain_, faces, found.regions);
  }

  /// Faces that the triangles of a piece lie in; empty if there are no regions.
  [[nodiscard]] std::vector<std::int32_t> faces_of(const NamedMesh& piece, std::size_t k) {
    if (!faces_) return {};
    if (!whole_) found_[k].parts = check_piece(piece, order()).parts;
    DisjointSets<std::int32_t> parts = std::move(*found_[k].parts);
    found_[k].parts.reset();
    return faces_->of_triangles(whole_ ? kNone : static_cast<std::int32_t>(k), piece.mesh().triangles.size(), parts);
  }

  [[nodiscard]] CheckedBounds bounds_in(const std::vector<std::int32_t>& faces) const {
    CheckedBounds bounds = bounds_;
    if (faces_ && options_.plain.region_areas)
      bounds.region_area = [&](std::size_t t) {
        const Pslg::Region* region = faces[t] == kNone ? nullptr : domain_->region_of(faces[t]);
        return region != nullptr ? region->max_area : 0;
      };
    return bounds;
  }

  /// Of a mesh with no flaws but in quality.
  void check_channels() {
    const std::uint64_t quality = findings_.count(Flaw::kSmallAngle) + findings_.count(Flaw::kLargeArea);
    if (options_.across.layers == 0 || findings_.total() > quality) return;
    if (whole_) return with_piece(0, [&](const NamedMesh& piece) { check_channels_of(piece.mesh()); });
    std::vector<Mesh> pieces(pieces_.count);
    for_each_piece([&](const NamedMesh& piece, std::size_t k) { pieces[k] = piece.mesh(); });
    MergeFaults faults;
    check_channels_of(merge_pieces(pieces, faults));
  }

  void check_channels_of(const Mesh& mesh) {
    const auto is_corner = [&](std::int32_t v) { return corners_->find(mesh.points[v]) != kNone; };
    report_.across = corners_ ? check_across(mesh, is_corner, options_.across, findings_)
                              : check_across(mesh, {}, options_.across, findings_);
  }

  /// Inside pieces: a mesh without other flaws has none, for it covers no place twice.
  void list_duplicates() {
    if (findings_.empty()) return;
    std::vector<Findings> findings(pieces_.count, Findings(options_.max_listed));
    for_each_piece([&](const NamedMesh& piece, std::size_t k) {
      std::vector<char> used(piece.mesh().points.size());
      for (const auto& triangle : piece.mesh().triangles)
        for (const std::int32_t v : triangle) used[v] = 1;
      const auto is_inside = [&](std::int32_t v) {
        const auto known = std::ranges::lower_bound(frame_.mesh.numbers, piece.number(v));
        return known == frame_.mesh.numbers.end() || *known != piece.number(v) ||
               frame_.marks[known - frame_.mesh.numbers.begin()] == 0;
      };
      PointIndex index(piece.mesh().points);
      check_duplicates(
          piece, [&](std::int32_t v) { return used[v] != 0; }, is_inside, index, findings[k]);
    });
    for (const Findings& piece : findings) findings_.append(piece);
  }

  const Pieces& pieces_;
  bool whole_;  // there is one, and it is a mesh of its own
  const Pslg* input_;
  const VerifyOptions& options_;
  std::optional<SizeCheck> size_;
  std::optional<StepCheck> step_;
  CheckedBounds bounds_;
  VerifyReport report_;
  Findings findings_;
  std::optional<Domain> domain_;
  std::optional<std::string> conflict_;
  std::optional<PointIndex> corners_;  // corners of the domain
  bool has_regions_ = false;

  std::vector<PieceReport> found_;
  std::vector<std::int64_t> shared_;  // see PieceOrder
  bool computable_ = true;
  std::size_t used_points_ = 0;
  Interfaces interfaces_;

  Frame frame_;
  std::optional<CornerTable> table_;  // for the frame
  std::optional<PointIndex> index_;   // marked points of the frame, by coordinates
  std::optional<Subsegments> subsegments_;
  std::optional<DisjointSets<std::int32_t>> parts_;  // triangles that subsegments do not separate, if there are regions
  std::optional<FacesOfParts> faces_;
};

VerifyReport verify_whole(const Mesh& mesh, const Pslg* input, const VerifyOptions& options) {
  const Pieces one{1, [&](std::size_t, const Pieces::Show& show) { show(mesh); }};
  return Verification(one, true, input, options).run();
}

}  // namespace

VerifyReport verify(const Mesh& mesh, const VerifyOptions& options) {
  return verify_whole(mesh, nullptr, options);
}

VerifyReport verify(const Mesh& mesh, const Pslg& input, const VerifyOptions& options) {
  return verify_whole(mesh, &input, options);
}

VerifyReport verify_pieces(const Pieces& pieces, const Pslg* input, const VerifyOptions& options) {
  return Verification(pieces, false, input, options).run();
}

VerifyReport verify_pieces(std::span<const Mesh> pieces, const Pslg* input, const VerifyOptions& options) {
  const Pieces in_memory{pieces.size(), [&](std::size_t k, const Pieces::Show& show) { show(pieces[k]); }};
  return verify_pieces(in_memory, input, options);
}

}  // namespace driftmesh
