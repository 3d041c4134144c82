#include "distributed/piece_series.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "distributed/assembly.hpp"
#include "distributed/piece_builder.hpp"

namespace driftmesh {
namespace {

/// The piece of each subdomain. Another one begins where the expected triangles suffice for that.
IdVector<SubdomainId, Rank> pieces_of(const Decomposition& decomposition) {
  IdVector<SubdomainId, Rank> pieces;
  double before = 0;  // triangles
  std::int32_t k = 0;
  for (const Decomposition::Subdomain& s : decomposition.subdomains) {
    if (before >= kTrianglesInSeries) {
      before = 0;
      ++k;
    }
    before += s.predicted;
    pieces.push_back(Rank{k});
  }
  return pieces;
}

}  // namespace

std::int32_t PieceSeries::count(const Decomposition& decomposition) {
  return to_int(pieces_of(decomposition).back()) + 1;
}

PieceSeries::PieceSeries(const Decomposition& decomposition, const std::map<SubdomainId, Subdomain>& subdomains,
                         std::vector<SubdomainCensus> census, const Pslg& pslg)
    : decomposition_(decomposition), held_(subdomains), pslg_(pslg), census_(std::move(census)) {
  PieceAssembly whole(Rank{0}, 1, decomposition, held_by_rank(subdomains), census_);
  exchange_directly(IdVector<Rank, Exchange*>{&whole});
  subdomains_ = whole.subdomains();
  subdomains_.rank = pieces_of(decomposition);
  roots_ = whole.roots();
}

DistributedPiece PieceSeries::piece(Rank k) const {
  const auto [begin, end] = std::equal_range(subdomains_.rank.begin(), subdomains_.rank.end(), k);
  const std::span census =
      std::span(census_).subspan(to_index(begin - subdomains_.rank.begin()), to_index(end - begin));
  std::vector<GlobalRootId> own;
  for (const SubdomainCensus& subdomain : census)
    for (const SubdomainCensus::Root& root : subdomain.roots) own.push_back(root.root);
  std::sort(own.begin(), own.end());
  std::vector<NumberedRoot> roots;
  std::ranges::copy_if(roots_, std::back_inserter(roots),
                       [&](const NumberedRoot& r) { return std::ranges::binary_search(own, r.root); });
  const HeldSubdomains held = [&](const ShowSubdomain& show) {
    for (const SubdomainCensus& subdomain : census) show_subdomain(held_.at(subdomain.id), show);
  };
  DistributedPiece piece = PieceBuilder(k, decomposition_, subdomains_, roots, census).build(held, pslg_);
  piece.ranks = size();
  return piece;
}

}  // namespace driftmesh
