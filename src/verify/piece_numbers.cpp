#include "verify/piece_numbers.hpp"

#include <algorithm>

#include "base/formatted.hpp"

namespace driftmesh {

PieceNumbers::PieceNumbers(std::span<const PieceReport> pieces) {
  std::vector<std::int64_t> marked;  // points on rims are in several pieces
  std::size_t points = 0;
  for (const PieceReport& piece : pieces) {
    points += piece.points;
    all_.append(piece.inside);
    const Frame& frame = piece.frame;
    for (std::size_t v = 0; v < frame.marks.size(); ++v)
      if (frame.marks[v] != 0) marked.push_back(frame.mesh.numbers[v]);
  }
  std::ranges::sort(marked);
  marked.erase(std::unique(marked.begin(), marked.end()), marked.end());
  NumberRuns of_rims;
  for (const std::int64_t number : marked) of_rims.add(number);
  all_.append(of_rims);
  all_.sort();
  too_large_ = all_.largest() >= static_cast<std::int64_t>(points);
}

void PieceNumbers::check_largest(Findings& findings) const {
  if (too_large_)
    findings.add(Flaw::kPiecesDisagree, [&] {
      return formatted("numbers go up to {}, but all pieces together have {} points: pieces are missing",
                       all_.largest(), all_.count());
    });
}

void PieceNumbers::check_gaps(Findings& findings) const {
  if (too_large_) return;
  std::int64_t end = 0;
  for (const NumberRuns::Run& run : all_.runs()) {
    for (std::int64_t n = end; n < run.first; ++n)
      findings.add(Flaw::kPiecesDisagree, [&] { return formatted("point {} is in no piece", n); });
    end = std::max(end, run.end);
  }
}

}  // namespace driftmesh
