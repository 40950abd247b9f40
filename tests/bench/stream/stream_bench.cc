// Prints sizes and speeds of the frame stream beside other ways to store the same frames, and what
// a frame with fracture costs. Asserts nothing. Speeds are of one thread, by its own clock, as
// float32 positions. `core_stream_bench [bar | noisy | large | simulated | fracture |
// fracture_surface] ...`; without names all but large.

#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/stopwatch.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "tests/bench/stream/break_motion.h"
#include "tests/bench/stream/other_codecs.h"
#include "tests/bench/stream/simulated_frames.h"

namespace cleave {
namespace {

constexpr int64_t kFrames = 96;
constexpr int kRounds = 5;  // of which the best counts, where frames are timed one by one

double ThreadSeconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// By the wall clock, and by that of all threads together, which other programs do not disturb.
class Watch {
 public:
  double Milliseconds() const { return 1e3 * wall_.Seconds(); }
  double ThreadMilliseconds() const { return 1e3 * (ProcessSeconds() - start_); }

 private:
  static double ProcessSeconds() {
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  Stopwatch wall_;
  double start_ = ProcessSeconds();
};

// Frames to measure on.
struct Sequence {
  std::string name;
  const TetMesh* mesh;
  const Incidence* incidence;
  int64_t frames;
  std::function<void(int64_t, Frame&)> get;
};

double Diagonal(const TetMesh& mesh) {
  Vec3 low = mesh.rest_positions.front();
  Vec3 high = low;
  for (const Vec3& x : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis]);
      high[axis] = std::max(high[axis], x[axis]);
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

struct Cost {
  double bytes = 0;
  double encode_seconds = 0;
  double decode_seconds = 0;
  int64_t frames = 0;

  void Print(const char* name, double nodes) const {
    const double megabytes = 12e-6 * nodes * static_cast<double>(frames);
    std::printf("    %-34s %8.3f B/v %8.0f MB/s %8.0f MB/s\n", name,
                bytes / nodes / static_cast<double>(frames), megabytes / encode_seconds,
                megabytes / decode_seconds);
  }
};

StreamParameters ParametersOf(const Sequence& sequence, double tolerance, uint16_t predictor,
                              uint16_t coder, uint16_t view = kViewState) {
  StreamParameters parameters;
  parameters.mesh_sha256 = std::string(32, 'm');
  parameters.edge_count = sequence.incidence->edges.size();
  parameters.tet_count = sequence.mesh->tets.size();
  parameters.tolerance = tolerance;
  parameters.predictor_id = predictor;
  parameters.coder_id = coder;
  parameters.view_id = view;
  return parameters;
}

// The frame stream itself, all frames; then its phases.
void MeasureStream(const Sequence& sequence, double tolerance, uint16_t predictor, uint16_t coder,
                   const char* name, uint16_t view = kViewState) {
  const StreamMesh mesh(sequence.mesh->rest_positions, sequence.incidence->edges,
                        sequence.mesh->tets);
  const auto header = MakeStreamHeader(ParametersOf(sequence, tolerance, predictor, coder, view),
                                       mesh.rest_positions);
  auto encoder = FrameEncoder::Create(*header, mesh);
  auto decoder = FrameDecoder::Create(encoder->header_bytes(), mesh);
  Cost all;
  Cost keys, breaking, others;
  double worst = 0;
  size_t broken = 0;
  Frame frame;
  for (int64_t number = 0; number < sequence.frames; ++number) {
    sequence.get(number, frame);
    const double start = ThreadSeconds();
    const auto encoded = encoder->Encode(frame);
    const double between = ThreadSeconds();
    const absl::Status applied = encoded.ok() ? decoder->Apply(encoded->bytes) : encoded.status();
    const double end = ThreadSeconds();
    if (!applied.ok()) {
      std::printf("%s\n", applied.ToString().c_str());
      return;
    }
    const bool breaks = frame.broken_edges.size() != broken;
    broken = frame.broken_edges.size();
    Cost& phase = encoded->header.kind == FrameKind::kKey ? keys : breaks ? breaking : others;
    for (Cost* cost : {&all, &phase}) {
      cost->bytes += static_cast<double>(encoded->bytes.size());
      cost->encode_seconds += between - start;
      cost->decode_seconds += end - between;
      ++cost->frames;
    }
    const std::vector<uint8_t>& visible = decoder->frame().visible;
    for (size_t node = 0; node < frame.positions.size(); ++node) {
      if (!visible.empty() && visible[node] == 0) continue;
      for (size_t axis = 0; axis < 3; ++axis) {
        worst = std::max(
            worst, std::abs(frame.positions[node][axis] - decoder->frame().positions[node][axis]));
      }
    }
  }
  const auto nodes = static_cast<double>(sequence.mesh->rest_positions.size());
  all.Print(name, nodes);
  if (predictor == kPredictorInterpolation && coder == kCoderContextRans) {
    keys.Print("  its key frames", nodes);
    if (breaking.frames > 0) breaking.Print("  its frames with fracture", nodes);
    others.Print("  its other frames", nodes);
    std::printf("    %.0f bytes a frame, worst error %.5f of the tolerance\n",
                all.bytes / static_cast<double>(all.frames), worst / tolerance);
  }
}

void MeasureOther(const Sequence& sequence, double tolerance, OtherCodec& codec) {
  Cost cost;
  Frame frame;
  std::vector<float> positions;
  for (int64_t number = 0; number < sequence.frames; ++number) {
    sequence.get(number, frame);
    positions.clear();
    for (const Vec3& x : frame.positions) {
      for (const double value : x) positions.push_back(static_cast<float>(value));
    }
    const double start = ThreadSeconds();
    const std::string coded = codec.Encode(positions, tolerance);
    const double between = ThreadSeconds();
    codec.Decode(coded);
    cost.decode_seconds += ThreadSeconds() - between;
    cost.encode_seconds += between - start;
    cost.bytes += static_cast<double>(coded.size());
    ++cost.frames;
  }
  cost.Print(codec.name(), static_cast<double>(sequence.mesh->rest_positions.size()));
}

void Compare(const Sequence& sequence) {
  std::printf("%s: %zu nodes, %zu edges, %lld frames\n", sequence.name.c_str(),
              sequence.mesh->rest_positions.size(), sequence.incidence->edges.size(),
              static_cast<long long>(sequence.frames));
  for (const double share : {1e-4, 1e-5}) {
    const double tolerance = share * Diagonal(*sequence.mesh);
    std::printf("  tolerance %.0e of the diagonal %15s %13s %13s\n", share, "", "encode", "decode");
    for (const std::unique_ptr<OtherCodec>& codec : MakeOtherCodecs()) {
      MeasureOther(sequence, tolerance, *codec);
    }
    for (const std::string& name : MissingCodecs()) {
      std::printf("  %s: not compared, built without it (deploy/install.sh --benchmarks)\n",
                  name.c_str());
    }
    MeasureStream(sequence, tolerance, kPredictorTemporal, kCoderZstdPlanes, "stream, predictor 1");
    MeasureStream(sequence, tolerance, kPredictorInterpolation, kCoderZstdPlanes,
                  "stream, predictor 2, zstd");
    MeasureStream(sequence, tolerance, kPredictorInterpolation, kCoderContextRans,
                  "stream, predictor 2, rANS");
    MeasureStream(sequence, tolerance, kPredictorInterpolation, kCoderContextRans,
                  "the same, surface view", kViewSurface);
    std::fflush(stdout);
  }
}

void CompareBar(const char* name, int cells, double noise) {
  const BreakingBar bar = MakeBreakingBar(cells);
  const double noise_metres = noise * 1e-4 * Diagonal(bar.mesh);
  Compare({name, &bar.mesh, &bar.incidence, kFrames,
           [&](int64_t number, Frame& frame) { MoveBar(bar, number, noise_metres, frame); }});
}

void CompareSimulated() {
  const SimulatedFrames simulated = SimulateBreakingBar();
  Compare({"simulated bar, pulled until it breaks", &simulated.mesh, &simulated.incidence,
           static_cast<int64_t>(simulated.frames.size()), [&](int64_t number, Frame& frame) {
             frame = simulated.frames[static_cast<size_t>(number)];
           }});
}

// What frames with fracture cost by the wall clock: all that it takes to encode and to decode one,
// and of that stencils, pieces and what is in view.
void MeasureFracture(int cells, int threads, uint16_t view) {
  const BreakingBar bar = MakeBreakingBar(cells);
  const Sequence sequence = {"", &bar.mesh, &bar.incidence, 0, {}};
  const StreamMesh mesh(bar.mesh.rest_positions, bar.incidence.edges, bar.mesh.tets);
  tbb::task_arena(threads).execute([&] {
    const NodeOrder order = MakeNodeOrder(bar.mesh.rest_positions);
    std::vector<Vec3> by_place;
    for (const int32_t node : order.nodes) {
      by_place.push_back(bar.mesh.rest_positions[static_cast<size_t>(node)]);
    }
    const Stopwatch setup;
    const bool is_surface = view == kViewSurface;
    const Stencils at_rest = is_surface ? Stencils(order, by_place, mesh)
                                        : Stencils(order, by_place, bar.incidence.edges);
    std::printf("fracture, %s view: %zu nodes, %d threads; stencils at first %.0f ms\n",
                is_surface ? "surface" : "state", by_place.size(), threads, 1e3 * setup.Seconds());
    const auto header =
        MakeStreamHeader(ParametersOf(sequence, 1e-4 * Diagonal(bar.mesh), kPredictorInterpolation,
                                      kCoderContextRans, view),
                         mesh.rest_positions);
    const auto encoder_at_rest = FrameEncoder::Create(*header, mesh);
    const auto decoder_at_rest = FrameDecoder::Create(encoder_at_rest->header_bytes(), mesh);
    // From a key frame, past the frame after it, whose statistics are fresh.
    std::vector<Frame> frames;
    for (int64_t number = BreakingBar::kFirstBreak - 2; number <= BreakingBar::kLastBreak;
         ++number) {
      MoveBar(bar, number, 0, frames.emplace_back());
    }
    struct Row {
      size_t touched = 0;
      size_t fresh = 0;
      int32_t pieces = 0;
      bool key = false;
      std::array<double, 6> times;
    };
    std::vector<Row> rows(frames.size());
    for (Row& row : rows) row.times.fill(1e9);
    for (int round = 0; round < kRounds; ++round) {
      Stencils stencils = at_rest;
      FrameEncoder encoder = *encoder_at_rest;
      FrameDecoder decoder = *decoder_at_rest;
      for (size_t at = 0; at < frames.size(); ++at) {
        Row& row = rows[at];
        const auto took = [&](size_t column, const Watch& watch) {
          row.times[column] = std::min(row.times[column], watch.Milliseconds());
          row.times[column + 1] = std::min(row.times[column + 1], watch.ThreadMilliseconds());
        };
        const Watch of_stencils;
        row.touched = stencils.SetBroken(order, frames[at].broken_edges).size();
        took(0, of_stencils);
        const Watch of_encoding;
        const auto encoded = encoder.Encode(frames[at]);
        took(2, of_encoding);
        const Watch of_decoding;
        const absl::Status applied = decoder.Apply(encoded->bytes);
        took(4, of_decoding);
        if (!applied.ok()) std::printf("%s\n", applied.ToString().c_str());
        row.fresh = stencils.fresh().size();
        row.pieces = stencils.pieces().count();
        row.key = encoded->header.kind == FrameKind::kKey;
      }
    }
    std::printf("  %5s %7s %8s %7s %6s   best of %d, ms by the wall clock (of all threads):\n", "",
                "edges", "stencils", "come in", "", kRounds);
    std::printf("  %5s %7s %8s %7s %6s %17s %17s %17s\n", "frame", "break", "anew", "view",
                "pieces", "stencils, pieces", "encode", "decode");
    size_t broken = 0;
    for (size_t at = 0; at < frames.size(); ++at) {
      const Row& row = rows[at];
      std::printf("  %5lld %7zu %8zu %7zu %6d", static_cast<long long>(frames[at].frame),
                  frames[at].broken_edges.size() - broken, row.touched, row.fresh, row.pieces);
      for (size_t column = 0; column < row.times.size(); column += 2) {
        std::printf(" %8.2f (%6.2f)", row.times[column], row.times[column + 1]);
      }
      std::printf("%s\n", row.key ? ", a key frame" : "");
      broken = frames[at].broken_edges.size();
    }
  });
}

}  // namespace
}  // namespace cleave

int main(int count, char** arguments) {
  std::vector<std::string> names(arguments + 1, arguments + count);
  if (names.empty()) names = {"bar", "noisy", "simulated", "fracture", "fracture_surface"};
  for (const std::string& name : names) {
    tbb::task_arena(1).execute([&] {
      if (name == "bar") cleave::CompareBar("bar by formulas", 16, 0);
      if (name == "noisy") cleave::CompareBar("bar by formulas, noise of 0.5e-4 D", 16, 0.5);
      if (name == "large") cleave::CompareBar("large bar by formulas", 36, 0);
      if (name == "simulated") cleave::CompareSimulated();
    });
    if (name == "fracture") {
      cleave::MeasureFracture(36, 1, cleave::kViewState);
      cleave::MeasureFracture(36, 2, cleave::kViewState);
    }
    if (name == "fracture_surface") {
      cleave::MeasureFracture(36, 1, cleave::kViewSurface);
      cleave::MeasureFracture(36, 2, cleave::kViewSurface);
    }
  }
}
