#include "proto/convert/impurity_preview.h"

namespace cleave {

v1::PreviewImpurityResponse MessageFromPreview(const ImpurityPreview& preview, bool with_edges) {
  v1::PreviewImpurityResponse message;
  message.mutable_potencies()->Add(preview.potencies.begin(), preview.potencies.end());
  message.set_edge_count(static_cast<int64_t>(preview.edges.size()));
  message.set_affected_edges(preview.affected_edges);
  message.set_weakest(preview.weakest);
  message.set_strongest(preview.strongest);
  for (size_t edge = 0; with_edges && edge < preview.edges.size(); ++edge) {
    if (preview.affected[edge] == 0) continue;
    message.mutable_edge_nodes()->Add(preview.edges[edge].begin(), preview.edges[edge].end());
    message.add_weakenings(preview.weakenings[edge]);
    message.add_strengths(preview.strengths[edge]);
  }
  return message;
}

}  // namespace cleave
