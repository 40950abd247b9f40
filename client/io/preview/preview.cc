#include "client/io/preview/preview.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/io/preview/motion_survey.h"
#include "client/io/preview/studio.h"
#include "client/io/preview/webp_animation.h"
#include "client/io/series/write_aside.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/picture/legend.h"
#include "core/picture/text.h"

namespace cleave {
namespace {

constexpr Color kPage = {1, 1, 1};

int Round(double value) { return static_cast<int>(std::lround(value)); }

// Columns that give the sheet a handy shape, rows full where that costs little.
int ChooseColumns(int tiles, double aspect) {
  int best = 1;
  double least = 1e9;
  for (int columns = 1; columns <= tiles; ++columns) {
    const int rows = (tiles + columns - 1) / columns;
    const double shape = aspect * columns / rows / 1.45;
    const double empty = static_cast<double>(rows * columns - tiles) / tiles;
    const double cost = std::abs(std::log(shape)) + 2 * empty;
    if (cost < least) {
      least = cost;
      best = columns;
    }
  }
  return best;
}

void Paste(const Image& tile, int left, int top, Image& sheet) {
  for (int y = 0; y < tile.height; ++y) {
    std::copy_n(tile.at(0, y), 3 * static_cast<size_t>(tile.width), sheet.at(left, top + y));
  }
}

absl::Status Stopped(int64_t done, int64_t total) {
  return absl::CancelledError(absl::StrCat("stopped after ", done, " of ", total, " pictures"));
}

// A grid of pictures in their order, under title and legend.
absl::StatusOr<Image> ComposeSheet(const Studio& studio, int tiles, int columns,
                                   const PreviewOptions& options,
                                   const std::function<absl::StatusOr<Image>(int)>& draw,
                                   const Progress& progress) {
  if (columns == 0) columns = ChooseColumns(tiles, studio.aspect());
  const int rows = (tiles + columns - 1) / columns;
  const int gap = std::max(2, studio.width() / 60);
  const double letters = 1.25 * studio.LetterHeight();
  const double legend_letters = 0.8 * letters;
  const bool has_head = !options.title.empty() || LegendWidth(studio.legend(), 1) > 0;
  const TextStyle bold{.height = letters, .pen = 0.18};
  const int64_t width = int64_t{columns} * (studio.width() + gap) + gap;
  const std::string title = Shortened(options.title, static_cast<double>(width) - 3.0 * gap, bold);
  const double title_width = TextWidth(title, bold);
  const double legend_width = LegendWidth(studio.legend(), legend_letters);
  const bool two_lines =
      !options.title.empty() && title_width + legend_width + 6 * gap > static_cast<double>(width);
  const int head = has_head ? Round((two_lines ? 5.0 : 2.6) * letters) : gap;
  const int64_t height = head + int64_t{rows} * (studio.height() + gap);
  if (width > kMaxImageSide || height > kMaxImageSide) {
    return absl::InvalidArgumentError(absl::StrCat("a sheet of ", width, " x ", height,
                                                   " pixels is above ", kMaxImageSide,
                                                   " at a side: make tiles fewer or smaller"));
  }
  Image image(static_cast<int>(width), static_cast<int>(height));
  FillRectangle(0, 0, image.width, image.height, kPage, image);
  DrawText(title, 1.5 * gap, 1.75 * letters, bold, image);
  const double legend_left = two_lines || options.title.empty()
                                 ? 1.5 * gap
                                 : static_cast<double>(width) - 1.5 * gap - legend_width;
  DrawLegend(studio.legend(), legend_left, (two_lines ? 4.1 : 1.75) * letters, legend_letters,
             image);
  for (int i = 0; i < tiles; ++i) {
    CLEAVE_ASSIGN_OR_RETURN(const Image tile, draw(i));
    Paste(tile, gap + i % columns * (studio.width() + gap),
          head + i / columns * (studio.height() + gap), image);
    if (progress && !progress(i + 1, tiles)) return Stopped(i + 1, tiles);
  }
  return image;
}

absl::Status CheckTurntable(const TurntableOptions& turntable) {
  Faults faults;
  if (turntable.pictures < 2 || turntable.pictures > 1000) {
    faults.Error("pictures", absl::StrCat(turntable.pictures, " is outside [2, 1000]"));
  }
  if (turntable.tiles < 2 || turntable.tiles > 100) {
    faults.Error("tiles", absl::StrCat(turntable.tiles, " is outside [2, 100]"));
  }
  if (!(turntable.frames_per_second >= 0.1 && turntable.frames_per_second <= 1000)) {
    faults.Error("frames_per_second",
                 absl::StrCat(turntable.frames_per_second, " is outside [0.1, 1000]"));
  }
  return faults.ToStatus();
}

absl::Status CheckPosition(const FrameSource& frames, int64_t position) {
  if (position >= 0 && position < frames.count) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("frame position ", position, " is outside [0, ", frames.count, ")"));
}

// A run of one of its frames.
absl::StatusOr<FrameSource> OneOf(const FrameSource& frames, int64_t position) {
  CLEAVE_RETURN_IF_ERROR(CheckPosition(frames, position));
  FrameSource one;
  one.count = 1;
  one.read = [&frames, position](int64_t) { return frames.read(position); };
  one.pass_by = [&frames, position](int64_t, const FrameSource::Visit& visit) -> absl::Status {
    for (int64_t before = 0; before <= position; ++before) {
      if (frames.pass_by) CLEAVE_RETURN_IF_ERROR(frames.pass_by(before, visit));
      if (before == position) break;
      CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames.read(before));
      CLEAVE_RETURN_IF_ERROR(visit(frame));
    }
    return absl::OkStatus();
  };
  return one;
}

// A frame on a stand that turns, and the run of it that the studio sees.
struct Turning {
  FrameSource one;
  std::unique_ptr<Studio> studio;
};

absl::StatusOr<std::unique_ptr<Turning>> MakeTurning(const TetMesh& mesh, const FrameSource& frames,
                                                     int64_t position,
                                                     const TurntableOptions& turntable,
                                                     const PreviewOptions& options) {
  CLEAVE_RETURN_IF_ERROR(CheckTurntable(turntable));
  auto turning = std::make_unique<Turning>();
  CLEAVE_ASSIGN_OR_RETURN(turning->one, OneOf(frames, position));
  CLEAVE_ASSIGN_OR_RETURN(turning->studio,
                          Studio::Create(mesh, turning->one, options, Stand::kTurntable));
  return turning;
}

double Angle(int picture, int pictures) { return 2 * std::numbers::pi * picture / pictures; }

}  // namespace

absl::StatusOr<Image> RenderStill(const TetMesh& mesh, const FrameSource& frames, int64_t position,
                                  const PreviewOptions& options) {
  CLEAVE_RETURN_IF_ERROR(CheckPosition(frames, position));
  CLEAVE_ASSIGN_OR_RETURN(const auto made, Studio::Create(mesh, frames, options));
  Studio& studio = *made;
  CLEAVE_ASSIGN_OR_RETURN(Image image, studio.Draw(position));
  studio.DrawHead(image);
  return image;
}

absl::StatusOr<Image> RenderContactSheet(const TetMesh& mesh, const FrameSource& frames,
                                         const SheetOptions& sheet, const PreviewOptions& options,
                                         const Progress& progress) {
  if (sheet.tiles < 1 || sheet.tiles > 1000 || sheet.columns < 0 || sheet.columns > sheet.tiles) {
    return absl::InvalidArgumentError(
        absl::StrCat(sheet.tiles, " tiles in ", sheet.columns,
                     " columns: tiles must be in [1, 1000], columns in [0, tiles]; 0 chooses"));
  }
  CLEAVE_ASSIGN_OR_RETURN(const auto made, Studio::Create(mesh, frames, options));
  Studio& studio = *made;
  const std::vector<int64_t> chosen = ChooseFrames(studio.survey(), sheet.tiles);
  const auto tiles = static_cast<int>(chosen.size());
  return ComposeSheet(
      studio, tiles, std::min(sheet.columns, tiles), options,
      [&](int i) { return studio.Draw(chosen[static_cast<size_t>(i)]); }, progress);
}

absl::StatusOr<std::string> RenderAnimation(const TetMesh& mesh, const FrameSource& frames,
                                            const AnimationOptions& animation,
                                            const PreviewOptions& options,
                                            const Progress& progress) {
  Faults faults;
  if (!(animation.frames_per_second >= 0.1 && animation.frames_per_second <= 1000)) {
    faults.Error("frames_per_second",
                 absl::StrCat(animation.frames_per_second, " is outside [0.1, 1000]"));
  }
  if (animation.max_frames < 1) {
    faults.Error("max_frames", absl::StrCat(animation.max_frames, " is not above 0"));
  }
  if (!(animation.hold_seconds >= 0 && animation.hold_seconds <= 60)) {
    faults.Error("hold_seconds", absl::StrCat(animation.hold_seconds, " is outside [0, 60]"));
  }
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  CLEAVE_ASSIGN_OR_RETURN(const auto made, Studio::Create(mesh, frames, options));
  Studio& studio = *made;
  CLEAVE_ASSIGN_OR_RETURN(WebpAnimation film, WebpAnimation::Create(studio.width(), studio.height(),
                                                                    animation.quality));
  const int64_t count = std::min<int64_t>(frames.count, animation.max_frames);
  for (int64_t i = 0; i < count; ++i) {
    const int64_t position = count == 1 ? frames.count - 1 : i * (frames.count - 1) / (count - 1);
    CLEAVE_ASSIGN_OR_RETURN(Image image, studio.Draw(position));
    studio.DrawHead(image);
    double seconds = 1 / animation.frames_per_second;
    if (i + 1 == count) seconds += animation.hold_seconds;
    CLEAVE_RETURN_IF_ERROR(film.Add(image, seconds));
    if (progress && !progress(i + 1, count)) return Stopped(i + 1, count);
  }
  return film.Finish();
}

absl::StatusOr<std::string> RenderTurntable(const TetMesh& mesh, const FrameSource& frames,
                                            int64_t position, const TurntableOptions& turntable,
                                            const PreviewOptions& options,
                                            const Progress& progress) {
  CLEAVE_ASSIGN_OR_RETURN(const auto turning,
                          MakeTurning(mesh, frames, position, turntable, options));
  Studio& studio = *turning->studio;
  CLEAVE_ASSIGN_OR_RETURN(WebpAnimation film, WebpAnimation::Create(studio.width(), studio.height(),
                                                                    turntable.quality));
  for (int i = 0; i < turntable.pictures; ++i) {
    CLEAVE_ASSIGN_OR_RETURN(Image image, studio.DrawTurned(0, Angle(i, turntable.pictures)));
    studio.DrawHead(image);
    CLEAVE_RETURN_IF_ERROR(film.Add(image, 1 / turntable.frames_per_second));
    if (progress && !progress(i + 1, turntable.pictures)) return Stopped(i + 1, turntable.pictures);
  }
  return film.Finish();
}

absl::StatusOr<Image> RenderTurntableSheet(const TetMesh& mesh, const FrameSource& frames,
                                           int64_t position, const TurntableOptions& turntable,
                                           const PreviewOptions& options,
                                           const Progress& progress) {
  CLEAVE_ASSIGN_OR_RETURN(const auto turning,
                          MakeTurning(mesh, frames, position, turntable, options));
  Studio& studio = *turning->studio;
  return ComposeSheet(
      studio, turntable.tiles, 0, options,
      [&](int i) { return studio.DrawTurned(0, Angle(i, turntable.tiles)); }, progress);
}

absl::Status WritePng(const std::string& path, const Image& image) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, EncodePng(image));
  return WriteAside(path, bytes);
}

}  // namespace cleave
