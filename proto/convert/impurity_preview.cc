#include "proto/convert/impurity_preview.h"

namespace cleave {

void WritePictureOptions(const ImpurityPictureOptions& options, v1::PictureOptions& message) {
  message.set_width(options.width);
  if (options.camera.azimuth) message.set_azimuth(*options.camera.azimuth);
  if (options.camera.elevation) message.set_elevation(*options.camera.elevation);
}

ImpurityPictureOptions PictureOptionsFromMessage(const v1::PictureOptions& message) {
  ImpurityPictureOptions options;
  if (message.has_width()) options.width = message.width();
  if (message.has_azimuth()) options.camera.azimuth = message.azimuth();
  if (message.has_elevation()) options.camera.elevation = message.elevation();
  return options;
}

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
