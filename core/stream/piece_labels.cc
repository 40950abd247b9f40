#include "core/stream/piece_labels.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "core/base/bytes.h"
#include "core/base/parallel.h"
#include "core/stream/rans.h"
#include "core/stream/residual_model.h"

namespace cleave {
namespace {

// What a node's label is coded as: the first of the ranked labels, the second, the third, or else
// by a byte, which is the rank, or kNew for a label that no node has had, or kListed.
constexpr size_t kSymbols = 4;
constexpr uint32_t kElse = 3;
constexpr uint32_t kNew = 254;
constexpr uint32_t kListed = 255;
constexpr uint32_t kNone = ~uint32_t{0};

// How sure the first of the ranked labels is: by how many more neighbours have it than the second.
constexpr size_t kContexts = 8;

using Frequencies = std::array<std::array<uint16_t, kSymbols>, kContexts>;

SymbolRange RangeOf(const std::array<uint16_t, kSymbols>& frequencies, size_t symbol) {
  uint16_t start = 0;
  for (size_t s = 0; s < symbol; ++s) start = static_cast<uint16_t>(start + frequencies[s]);
  return {start, frequencies[symbol]};
}

}  // namespace

PieceLabels::PieceLabels(const NodeOrder& order, const Stencils& unbroken,
                         std::span<const std::array<int32_t, 2>> edges) {
  const size_t count = order.nodes.size();
  const std::vector<int32_t> places = order.PlacesOfNodes();
  stencils_.resize(count);
  for (size_t place = 0; place < count; ++place) {
    std::array<int32_t, kStencilNodes>& stencil = stencils_[place];
    if (unbroken.near() == nullptr) {
      stencil = unbroken[static_cast<int32_t>(place)].places;
      continue;
    }
    const auto near = unbroken.near()->Of(static_cast<int32_t>(place));
    stencil.fill(near.empty() ? -1 : near[0].place);
    for (size_t k = 0; k < std::min(near.size(), kStencilNodes); ++k) stencil[k] = near[k].place;
  }
  edges_.reserve(edges.size());
  for (const auto& [a, b] : edges) {
    edges_.push_back({places[static_cast<size_t>(a)], places[static_cast<size_t>(b)]});
  }
}

PieceLabels::Ranking PieceLabels::Rank(size_t place, std::span<const int32_t> labels) const {
  Ranking ranking{};
  const std::array<int32_t, kStencilNodes>& stencil = stencils_[place];
  if (stencil[0] < 0) return ranking;
  // Nearly everywhere all have the same label.
  const int32_t label = labels[static_cast<size_t>(stencil[0])];
  bool same = true;
  for (const int32_t of_stencil : stencil) same &= labels[static_cast<size_t>(of_stencil)] == label;
  if (same) {
    ranking.labels[0] = label;
    ranking.count = 1;
    ranking.context = stencil[2] == stencil[0] ? 1 : 2;  // unused ones repeat the first
    return ranking;
  }
  std::array<size_t, kStencilNodes> votes{};
  for (size_t k = 0; k < kStencilNodes; ++k) {
    if (k > 0 && stencil[k] == stencil[0]) break;
    const int32_t other = labels[static_cast<size_t>(stencil[k])];
    size_t at = 0;
    while (at < ranking.count && ranking.labels[at] != other) ++at;
    if (at == ranking.count) ranking.labels[ranking.count++] = other;
    ++votes[at];
  }
  for (size_t end = 1; end < ranking.count; ++end) {
    for (size_t at = end; at > 0 && votes[at] > votes[at - 1]; --at) {
      std::swap(votes[at], votes[at - 1]);
      std::swap(ranking.labels[at], ranking.labels[at - 1]);
    }
  }
  ranking.context = 7 - std::min<size_t>(votes[0] - votes[1], 4);
  return ranking;
}

std::string PieceLabels::Encode(std::span<const int32_t> labels) const {
  const size_t count = stencils_.size();
  struct Choice {
    size_t context;
    uint32_t code;  // a rank, kNew or kListed
  };
  std::vector<Choice> choices(count);
  std::array<std::array<uint64_t, kSymbols>, kContexts> counts{};
  ParallelFor(static_cast<int64_t>(count), 4096, [&](int64_t begin, int64_t end) {
    for (auto at = static_cast<size_t>(begin); at < static_cast<size_t>(end); ++at) {
      const Ranking ranking = Rank(at, labels);
      uint32_t rank = 0;
      while (rank < ranking.count && ranking.labels[rank] != labels[at]) ++rank;
      choices[at] = {ranking.context, rank < ranking.count ? rank : kListed};
    }
  });
  int32_t labels_so_far = 0;
  for (size_t at = 0; at < count; ++at) {
    Choice& choice = choices[at];
    if (labels[at] == labels_so_far) {
      ++labels_so_far;
      choice.code = kNew;
    }
    ++counts[choice.context][std::min(choice.code, kElse)];
  }
  Frequencies frequencies;
  std::string coded;
  ByteWriter head(coded);
  for (size_t context = 0; context < kContexts; ++context) {
    ToFrequencies(counts[context].data(), kSymbols, frequencies[context].data());
    for (const uint16_t frequency : frequencies[context]) head.Put(frequency);
  }
  std::vector<RansSymbol> table;
  for (const auto& of_context : frequencies) {
    for (size_t symbol = 0; symbol < kSymbols; ++symbol) {
      table.emplace_back(RangeOf(of_context, symbol));
    }
  }
  RansWriter writer;
  uint16_t* symbols = writer.MoreSymbols(count);
  for (size_t at = 0; at < count; ++at) {
    const Choice& choice = choices[at];
    const uint32_t symbol = std::min(choice.code, kElse);
    *symbols++ = static_cast<uint16_t>(choice.context * kSymbols + symbol);
    if (symbol < kElse) continue;
    writer.PutBits(choice.code, 8);
    if (choice.code < kListed) continue;
    writer.PutBits(static_cast<uint32_t>(labels[at]), 32);
  }
  writer.EndSymbols(symbols);
  return coded + writer.Finish(table);
}

absl::StatusOr<std::vector<int32_t>> PieceLabels::Decode(absl::string_view coded) const {
  const size_t count = stencils_.size();
  ByteReader head(coded);
  Frequencies frequencies;
  bool fits = true;
  for (auto& of_context : frequencies) {
    uint32_t sum = 0;
    for (uint16_t& frequency : of_context) {
      frequency = head.Get<uint16_t>();
      fits &= frequency > 0;
      sum += frequency;
    }
    fits &= sum == kFrequencyOne;
  }
  if (!head.ok() || !fits) {
    return absl::DataLossError("topology labels have frequencies that do not add up");
  }
  RansReader reader(head.GetBytes(head.left()));
  std::vector<int32_t> labels(count);
  int32_t labels_so_far = 0;
  for (size_t at = 0; at < count; ++at) {
    const Ranking ranking = Rank(at, labels);
    const auto& of_context = frequencies[ranking.context];
    const uint32_t slot = reader.Slot();
    uint32_t code = 0;
    SymbolRange range = RangeOf(of_context, 0);
    while (slot >= uint32_t{range.start} + range.frequency) range = RangeOf(of_context, ++code);
    reader.Take(range);
    if (code == kElse) code = reader.Bits(8);
    if (code == kNew) {
      labels[at] = labels_so_far++;
      continue;
    }
    uint32_t label = kNone;
    if (code == kListed) {
      label = reader.Bits(32);
    } else if (code < ranking.count) {
      label = static_cast<uint32_t>(ranking.labels[code]);
    }
    if (label >= static_cast<uint32_t>(labels_so_far)) {
      return absl::DataLossError("topology labels name a label that is not there");
    }
    labels[at] = static_cast<int32_t>(label);
  }
  if (!reader.Finish()) return absl::DataLossError("topology labels do not end with their section");
  return Between(labels);
}

std::vector<int32_t> PieceLabels::Between(std::span<const int32_t> labels) const {
  constexpr int64_t kRun = 1 << 16;  // edges
  const auto count = static_cast<int64_t>(edges_.size());
  std::vector<std::vector<int32_t>> runs(static_cast<size_t>((count + kRun - 1) / kRun));
  ParallelFor(static_cast<int64_t>(runs.size()), 1, [&](int64_t begin, int64_t end) {
    for (int64_t run = begin; run < end; ++run) {
      for (int64_t edge = run * kRun; edge < std::min(count, (run + 1) * kRun); ++edge) {
        const auto& [a, b] = edges_[static_cast<size_t>(edge)];
        if (labels[static_cast<size_t>(a)] != labels[static_cast<size_t>(b)]) {
          runs[static_cast<size_t>(run)].push_back(static_cast<int32_t>(edge));
        }
      }
    }
  });
  std::vector<int32_t> between;
  for (const std::vector<int32_t>& run : runs) {
    between.insert(between.end(), run.begin(), run.end());
  }
  return between;
}

}  // namespace cleave
