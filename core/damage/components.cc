#include "core/damage/components.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace cleave {
namespace {

int32_t FindRoot(std::vector<int32_t>& parents, int32_t node) {
  while (parents[static_cast<size_t>(node)] != node) {
    int32_t& parent = parents[static_cast<size_t>(node)];
    parent = parents[static_cast<size_t>(parent)];
    node = parent;
  }
  return node;
}

}  // namespace

int32_t LabelComponents(const Incidence& incidence, std::span<const uint8_t> broken,
                        std::vector<int32_t>& labels) {
  // Union-find in place: a root is the smallest node of its tree, so every parent is at most its
  // child and one ascending sweep turns trees into labels.
  labels.resize(static_cast<size_t>(incidence.node_edges.rows()));
  std::iota(labels.begin(), labels.end(), 0);
  for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
    if (broken[edge] != 0) continue;
    const int32_t a = FindRoot(labels, incidence.edges[edge][0]);
    const int32_t b = FindRoot(labels, incidence.edges[edge][1]);
    if (a != b) labels[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
  }
  int32_t count = 0;
  for (size_t node = 0; node < labels.size(); ++node) {
    if (incidence.node_edges[static_cast<int64_t>(node)].empty()) {
      labels[node] = -1;
    } else if (labels[node] == static_cast<int32_t>(node)) {
      labels[node] = count++;
    } else {
      labels[node] = labels[static_cast<size_t>(labels[node])];
    }
  }
  return count;
}

}  // namespace cleave
