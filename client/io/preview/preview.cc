#include "client/io/preview/preview.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/io/preview/legend.h"
#include "client/io/preview/motion_survey.h"
#include "client/io/preview/text.h"
#include "client/io/preview/webp_animation.h"
#include "client/io/series/surface_sequence.h"
#include "client/io/series/write_aside.h"
#include "core/base/faults.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr int64_t kSurveyed = 256;
constexpr int64_t kStrainFrames = 12;
constexpr Color kPage = {1, 1, 1};
constexpr Color kFaint = {0.42f, 0.44f, 0.47f};

int Round(double value) { return static_cast<int>(std::lround(value)); }

// 1, 2 or 5 times a power of ten, at least `value`.
double RoundUp(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (value <= factor * power * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::string Percent(double part) { return absl::StrFormat("%.3g %%", 100 * part); }

// A time with as many digits as tell `step` (s) apart, in ms for runs that are over within one
// second.
std::string TimeLabel(double time, double step, double end) {
  const bool milli = std::abs(end) < 1;
  const double scale = milli ? 1e3 : 1;
  const int digits =
      step > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(step * scale))), 0, 9) : 1;
  return absl::StrFormat("%.*f %s", digits, time * scale, milli ? "ms" : "s");
}

std::map<int32_t, RegionLook> LooksOf(const TetMesh& mesh) {
  std::set<int32_t> ids(mesh.tet_regions.begin(), mesh.tet_regions.end());
  if (ids.empty()) ids.insert(0);
  std::map<int32_t, RegionLook> looks;
  for (const int32_t id : ids) {
    RegionLook& look = looks[id];
    look.slot = static_cast<int32_t>(looks.size()) - 1;
    look.label = mesh.tet_regions.empty() ? "body" : absl::StrCat("region ", id);
    for (const MeshRegion& region : mesh.regions) {
      if (region.id == id && !region.name.empty()) look.label = region.name;
    }
  }
  return looks;
}

// Everything that the pictures of one run share.
class Studio {
 public:
  static absl::StatusOr<Studio> Create(const TetMesh& mesh, const FrameSource& frames,
                                       const PreviewOptions& options) {
    CLEAVE_RETURN_IF_ERROR(CheckOptions(options));
    CLEAVE_ASSIGN_OR_RETURN(Renderer renderer, Renderer::Create());
    Studio studio(std::move(renderer), mesh, frames, options);
    CLEAVE_ASSIGN_OR_RETURN(studio.survey_, SurveyMotion(mesh, frames, kSurveyed));
    CLEAVE_RETURN_IF_ERROR(studio.Prepare());
    return studio;
  }

  const MotionSurvey& survey() const { return survey_; }
  const Legend& legend() const { return legend_; }
  int width() const { return options_.width; }
  int height() const { return height_; }
  double aspect() const { return static_cast<double>(options_.width) / height_; }

  SequenceOptions sequence_options() const {
    return {.strains = options_.color_by == ColorBy::kStrain};
  }

  // The picture of a frame, with time, pieces and broken edges below.
  absl::StatusOr<Image> Draw(int64_t position, SurfaceSequence& sequence) {
    CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames_.read(position));
    CLEAVE_RETURN_IF_ERROR(sequence.Advance(frame));
    CLEAVE_ASSIGN_OR_RETURN(Image image, renderer_.Render(sequence.surface(), camera_, style_,
                                                          options_.width, height_));
    const double size = LetterHeight();
    const double margin = 1.3 * size;
    const double baseline = height_ - margin;
    const std::string time = TimeLabel(frame.time, step_, survey_.times.back());
    DrawText(time, margin, baseline, {.height = size, .pen = 0.16}, image);
    const int64_t pieces = sequence.piece_count();
    const std::string counts = absl::StrFormat(
        "%d %s, %d broken %s", pieces, pieces == 1 ? "piece" : "pieces",
        sequence.surface().broken_edges, sequence.surface().broken_edges == 1 ? "edge" : "edges");
    const TextStyle faint{.height = 0.85 * size, .color = kFaint};
    const double width = TextWidth(counts, faint);
    if (width + TextWidth(time, faint) + 5 * margin < options_.width) {
      DrawText(counts, options_.width - margin - width, baseline, faint, image);
    }
    return image;
  }

  // Title and legend on top of a single picture.
  void DrawHead(Image& image) const {
    const double size = LetterHeight();
    const double margin = 1.3 * size;
    const TextStyle bold{.height = 1.15 * size, .pen = 0.18};
    DrawText(options_.title, margin, margin + size, bold, image);
    const double width = LegendWidth(legend_, 0.85 * size);
    const double title = options_.title.empty() ? 0 : TextWidth(options_.title, bold) + margin;
    double baseline = margin + size;
    if (title + width + 2 * margin > options_.width) baseline += 2.2 * size;
    DrawLegend(legend_, options_.width - margin - width, baseline, 0.85 * size, image);
  }

  double LetterHeight() const { return std::clamp(options_.width / 70.0, 7.5, 28.0); }

 private:
  Studio(Renderer renderer, const TetMesh& mesh, const FrameSource& frames,
         const PreviewOptions& options)
      : renderer_(std::move(renderer)), mesh_(mesh), frames_(frames), options_(options) {}

  static absl::Status CheckOptions(const PreviewOptions& options) {
    Faults faults;
    if (options.width < 16 || options.width > kMaxImageSide) {
      faults.Error("width", absl::StrCat(options.width, " is outside [16, ", kMaxImageSide, "]"));
    }
    if (options.height != 0 && (options.height < 16 || options.height > kMaxImageSide)) {
      faults.Error("height",
                   absl::StrCat(options.height, " is neither 0 nor in [16, ", kMaxImageSide, "]"));
    }
    if (options.strain_limit && !(*options.strain_limit > 0)) {
      faults.Error("strain_limit", absl::StrCat(*options.strain_limit, " is not above 0"));
    }
    return faults.ToStatus();
  }

  absl::Status Prepare() {
    CLEAVE_ASSIGN_OR_RETURN(const double natural, NaturalAspect(survey_.points, options_.camera));
    height_ = options_.height > 0 ? options_.height
                                  : std::clamp(Round(options_.width / natural), 16, kMaxImageSide);
    CLEAVE_ASSIGN_OR_RETURN(camera_, FrameCamera(survey_.points, aspect(), options_.camera));
    const size_t count = survey_.times.size();
    if (count > 1) {
      step_ = (survey_.times.back() - survey_.times.front()) / static_cast<double>(count - 1);
    }
    style_.color_by = options_.color_by;
    style_.samples = options_.samples;
    const auto looks = options_.regions.empty() ? LooksOf(mesh_) : options_.regions;
    for (const auto& [region, look] : looks) style_.region_slots[region] = look.slot;
    switch (options_.color_by) {
      case ColorBy::kStrain:
        CLEAVE_RETURN_IF_ERROR(ChooseStrainLimit());
        legend_.map_title = "largest principal strain";
        legend_.map_low = "0";
        legend_.map_high = Percent(style_.strain_limit);
        break;
      case ColorBy::kRegion:
        AddSwatches(looks);
        break;
      case ColorBy::kPiece:
        break;  // pieces have no names
    }
    return absl::OkStatus();
  }

  void AddSwatches(const std::map<int32_t, RegionLook>& looks) {
    std::set<std::string> named;
    for (const auto& [region, look] : looks) {
      if (!named.insert(look.label).second) continue;
      legend_.swatches.emplace_back(look.label, RegionColor(look.slot));
    }
    if (survey_.broken_edges.back() == 0) {
      if (legend_.swatches.size() == 1) legend_.swatches.clear();  // nothing to tell apart
      return;
    }
    const auto first = std::min_element(
        looks.begin(), looks.end(),
        [](const auto& a, const auto& b) { return a.second.slot < b.second.slot; });
    legend_.swatches.emplace_back("crack", InsideColor(first->second.slot));
  }

  absl::Status ChooseStrainLimit() {
    if (options_.strain_limit) {
      style_.strain_limit = *options_.strain_limit;
      return absl::OkStatus();
    }
    SurfaceSequence sequence(mesh_, {.strains = true});
    std::vector<float> strains;
    const size_t stride = std::max<size_t>(1, survey_.positions.size() / kStrainFrames);
    for (size_t i = 0; i < survey_.positions.size(); i += stride) {
      CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames_.read(survey_.positions[i]));
      CLEAVE_RETURN_IF_ERROR(sequence.Advance(frame));
      const auto& found = sequence.surface().strains;
      strains.insert(strains.end(), found.begin(), found.end());
    }
    double limit = 0;
    if (!strains.empty()) {
      const auto place = static_cast<std::ptrdiff_t>(strains.size() * 99 / 100);
      std::nth_element(strains.begin(), strains.begin() + place, strains.end());
      limit = strains[static_cast<size_t>(place)];
    }
    style_.strain_limit = RoundUp(std::max(limit, 1e-4));
    return absl::OkStatus();
  }

  Renderer renderer_;
  const TetMesh& mesh_;
  const FrameSource& frames_;
  const PreviewOptions& options_;
  MotionSurvey survey_;
  Camera camera_;
  RenderStyle style_;
  Legend legend_;
  int height_ = 0;
  double step_ = 0;  // s, between the frames looked at
};

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

}  // namespace

absl::StatusOr<Image> RenderStill(const TetMesh& mesh, const FrameSource& frames, int64_t position,
                                  const PreviewOptions& options) {
  if (position < 0 || position >= frames.count) {
    return absl::InvalidArgumentError(
        absl::StrCat("frame position ", position, " is outside [0, ", frames.count, ")"));
  }
  CLEAVE_ASSIGN_OR_RETURN(Studio studio, Studio::Create(mesh, frames, options));
  SurfaceSequence sequence(mesh, studio.sequence_options());
  CLEAVE_ASSIGN_OR_RETURN(Image image, studio.Draw(position, sequence));
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
  CLEAVE_ASSIGN_OR_RETURN(Studio studio, Studio::Create(mesh, frames, options));
  const std::vector<int64_t> chosen = ChooseFrames(studio.survey(), sheet.tiles);
  const auto tiles = static_cast<int>(chosen.size());
  const int columns =
      sheet.columns > 0 ? std::min(sheet.columns, tiles) : ChooseColumns(tiles, studio.aspect());
  const int rows = (tiles + columns - 1) / columns;
  const int gap = std::max(2, studio.width() / 60);
  const double letters = 1.25 * studio.LetterHeight();
  const double legend_letters = 0.8 * letters;
  const bool has_head = !options.title.empty() || LegendWidth(studio.legend(), 1) > 0;
  const TextStyle bold{.height = letters, .pen = 0.18};
  const int64_t width = int64_t{columns} * (studio.width() + gap) + gap;
  const double title_width = TextWidth(options.title, bold);
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
  DrawText(options.title, 1.5 * gap, 1.75 * letters, bold, image);
  const double legend_left = two_lines || options.title.empty()
                                 ? 1.5 * gap
                                 : static_cast<double>(width) - 1.5 * gap - legend_width;
  DrawLegend(studio.legend(), legend_left, (two_lines ? 4.1 : 1.75) * letters, legend_letters,
             image);
  SurfaceSequence sequence(mesh, studio.sequence_options());
  for (int i = 0; i < tiles; ++i) {
    CLEAVE_ASSIGN_OR_RETURN(const Image tile,
                            studio.Draw(chosen[static_cast<size_t>(i)], sequence));
    Paste(tile, gap + i % columns * (studio.width() + gap),
          head + i / columns * (studio.height() + gap), image);
    if (progress && !progress(i + 1, tiles)) return Stopped(i + 1, tiles);
  }
  return image;
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
  CLEAVE_ASSIGN_OR_RETURN(Studio studio, Studio::Create(mesh, frames, options));
  CLEAVE_ASSIGN_OR_RETURN(WebpAnimation film, WebpAnimation::Create(studio.width(), studio.height(),
                                                                    animation.quality));
  const int64_t count = std::min<int64_t>(frames.count, animation.max_frames);
  SurfaceSequence sequence(mesh, studio.sequence_options());
  for (int64_t i = 0; i < count; ++i) {
    const int64_t position = count == 1 ? frames.count - 1 : i * (frames.count - 1) / (count - 1);
    CLEAVE_ASSIGN_OR_RETURN(Image image, studio.Draw(position, sequence));
    studio.DrawHead(image);
    double seconds = 1 / animation.frames_per_second;
    if (i + 1 == count) seconds += animation.hold_seconds;
    CLEAVE_RETURN_IF_ERROR(film.Add(image, seconds));
    if (progress && !progress(i + 1, count)) return Stopped(i + 1, count);
  }
  return film.Finish();
}

absl::Status WritePng(const std::string& path, const Image& image) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, EncodePng(image));
  return WriteAside(path, bytes);
}

}  // namespace cleave
