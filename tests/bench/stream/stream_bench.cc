#include <tbb/task_arena.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/base/stopwatch.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "tests/bench/stream/break_motion.h"
using namespace cleave;
int main(int argc, char** argv) {
  int across = argc > 1 ? atoi(argv[1]) : 16;
  int threads = argc > 2 ? atoi(argv[2]) : 1;
  Stopwatch w0;
  const BreakingBar bar = MakeBreakingBar(across);
  printf("mesh %.2f s nodes %zu edges %zu\n", w0.Seconds(), bar.pieces.size(),
         bar.incidence.edges.size());
  StreamMesh mesh(bar.mesh.rest_positions, bar.incidence.edges);
  for (double share : {1e-4, 1e-5}) {
    tbb::task_arena(threads).execute([&] {
      StreamParameters pr{.mesh_sha256 = std::string(32, 'm'),
                          .edge_count = bar.incidence.edges.size(),
                          .tet_count = 1,
                          .tolerance = share * 4.24,
                          .predictor_id = 2,
                          .coder_id = (uint16_t)(argc > 3 ? atoi(argv[3]) : 1)};
      auto header = MakeStreamHeader(pr, bar.mesh.rest_positions);
      Stopwatch w1;
      auto enc = FrameEncoder::Create(*header, mesh);
      if (!enc.ok()) {
        printf("%s\n", enc.status().ToString().c_str());
        return;
      }
      printf("setup %.3f s\n", w1.Seconds());
      auto dec = FrameDecoder::Create(enc->header_bytes(), mesh);
      Frame f;
      double te[4] = {}, td[4] = {};
      size_t by[4] = {};
      int n[4] = {};
      double worst = 0;
      size_t brk = 0;
      for (int64_t i = 0; i < 96; ++i) {
        MoveBar(bar, i, 0, f);
        Stopwatch a;
        auto e = enc->Encode(f);
        double s = a.Seconds();
        if (!e.ok()) {
          printf("%s\n", e.status().ToString().c_str());
          return;
        }
        int k = e->header.kind == FrameKind::kKey ? 0
                : i < 32                          ? 1
                : f.broken_edges.size() != brk    ? 2
                                                  : 3;
        if (k == 2 && across > 30)
          printf("  fracture frame %ld: %zu new, enc %.1f ms\n", (long)i,
                 f.broken_edges.size() - brk, 1e3 * s);
        brk = f.broken_edges.size();
        Stopwatch b;
        auto st = dec->Apply(e->bytes);
        double s2 = b.Seconds();
        if (!st.ok()) {
          printf("%ld %s\n", (long)i, st.ToString().c_str());
          return;
        }
        te[k] += s;
        td[k] += s2;
        by[k] += e->bytes.size();
        n[k]++;
        for (size_t v = 0; v < f.positions.size(); ++v)
          for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(f.positions[v][c] - dec->frame().positions[v][c]));
      }
      const char* nm[] = {"key", "smooth", "break", "after"};
      for (int k = 0; k < 4; ++k)
        printf("%g %s: %.3f B/v  enc %.0f MB/s dec %.0f MB/s\n", share, nm[k],
               by[k] / (double)n[k] / bar.pieces.size(), 12e-6 * bar.pieces.size() * n[k] / te[k],
               12e-6 * bar.pieces.size() * n[k] / td[k]);
      printf("worst / tol %.5f\n", worst / header->tolerance);
    });
  }
}
