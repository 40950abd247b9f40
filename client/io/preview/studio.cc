#include "client/io/preview/studio.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/picture/text.h"

namespace cleave {
namespace {

constexpr int64_t kSurveyed = 256;
constexpr int64_t kStrainFrames = 12;
constexpr int kFramedTurns = 24;
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

double Worst(const std::vector<double>& potencies) {
  double worst = 0;
  for (const double potency : potencies) worst = std::max(worst, std::abs(potency));
  return worst;
}

// Of a camera above the ground, degrees.
double Elevation(const Camera& camera) {
  double sine = 0;
  for (size_t k = 0; k < 3; ++k) sine -= camera.forward[k] * camera.ground_normal[k];
  return std::asin(std::clamp(sine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

absl::Status CheckOptions(const TetMesh& mesh, const PreviewOptions& options) {
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
  const auto potencies = static_cast<int64_t>(options.node_potencies.size());
  if (potencies != 0 && potencies != mesh.node_count()) {
    faults.Error("node_potencies", absl::StrCat("has ", potencies, " items; the mesh has ",
                                                mesh.node_count(), " nodes"));
  } else if (options.color_by == ColorBy::kImpurity && potencies == 0) {
    faults.Error("color_by", "there are no impurities to show");
  }
  return faults.ToStatus();
}

}  // namespace

Studio::Studio(Renderer renderer, const TetMesh& mesh, const FrameSource& frames,
               const PreviewOptions& options)
    : renderer_(std::move(renderer)),
      mesh_(mesh),
      frames_(frames),
      options_(options),
      sequence_(mesh, {.strains = options.color_by == ColorBy::kStrain,
                       .damages = options.color_by == ColorBy::kDamage,
                       .node_potencies = options.node_potencies,
                       .render_mesh = options.render_mesh}) {}

absl::StatusOr<std::unique_ptr<Studio>> Studio::Create(const TetMesh& mesh,
                                                       const FrameSource& frames,
                                                       const PreviewOptions& options, Stand stand) {
  CLEAVE_RETURN_IF_ERROR(CheckOptions(mesh, options));
  CLEAVE_ASSIGN_OR_RETURN(Renderer renderer, Renderer::Create());
  std::unique_ptr<Studio> studio(new Studio(std::move(renderer), mesh, frames, options));
  CLEAVE_ASSIGN_OR_RETURN(studio->survey_, SurveyMotion(mesh, frames, kSurveyed));
  CLEAVE_RETURN_IF_ERROR(studio->Prepare(stand));
  return studio;
}

double Studio::LetterHeight() const { return std::clamp(options_.width / 70.0, 7.5, 28.0); }

absl::Status Studio::FollowTo(int64_t position) {
  const auto pass_by = [&](const Frame& frame) { return sequence_.PassBy(frame); };
  for (; followed_ <= position; ++followed_) {
    if (frames_.pass_by) CLEAVE_RETURN_IF_ERROR(frames_.pass_by(followed_, pass_by));
    if (followed_ == position) continue;  // Draw advances to it
    CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames_.read(followed_));
    CLEAVE_RETURN_IF_ERROR(pass_by(frame));
  }
  return absl::OkStatus();
}

absl::Status Studio::Show(int64_t position) {
  if (shown_ == position) return absl::OkStatus();
  shown_ = -1;
  solids_.reset();
  // Colours of pieces follow from all frames; of the rest only how crumbs are turned that no tet
  // holds any more, too little to read all frames for.
  if (options_.color_by == ColorBy::kPiece) CLEAVE_RETURN_IF_ERROR(FollowTo(position));
  CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames_.read(position));
  CLEAVE_RETURN_IF_ERROR(sequence_.Advance(frame));
  shown_props_ = PropsAt(options_.props, frame.frame);
  CLEAVE_ASSIGN_OR_RETURN(
      solids_, renderer_.Prepare(sequence_.surface(), shown_props_, camera_.scene_center, style_));
  shown_time_ = frame.time;
  shown_ = position;
  return absl::OkStatus();
}

absl::StatusOr<Image> Studio::Draw(int64_t position, const Camera& camera) {
  CLEAVE_RETURN_IF_ERROR(Show(position));
  CLEAVE_ASSIGN_OR_RETURN(
      Image image, renderer_.Draw(*solids_, camera, style_.samples, options_.width, height_));
  const double size = LetterHeight();
  const double margin = 1.3 * size;
  const double baseline = height_ - margin;
  const std::string time = TimeLabel(shown_time_, step_, survey_.times.back());
  DrawText(time, margin, baseline, {.height = size, .pen = 0.16, .rim = kRim}, image);
  const int64_t pieces = sequence_.piece_count();
  const std::string counts = absl::StrFormat(
      "%d %s, %d broken %s", pieces, pieces == 1 ? "piece" : "pieces",
      sequence_.surface().broken_edges, sequence_.surface().broken_edges == 1 ? "edge" : "edges");
  const TextStyle faint{.height = 0.85 * size, .color = kFaint, .rim = kRim};
  const double width = TextWidth(counts, faint);
  if (width + TextWidth(time, faint) + 5 * margin < options_.width) {
    DrawText(counts, options_.width - margin - width, baseline, faint, image);
  }
  return image;
}

void Studio::DrawHead(Image& image) const {
  const double size = LetterHeight();
  const double margin = 1.3 * size;
  const TextStyle bold{.height = 1.15 * size, .pen = 0.18, .rim = kRim};
  const std::string shown = Shortened(options_.title, options_.width - 2 * margin, bold);
  DrawText(shown, margin, margin + size, bold, image);
  const double width = LegendWidth(legend_, 0.85 * size);
  const double title = shown.empty() ? 0 : TextWidth(shown, bold) + margin;
  double baseline = margin + size;
  if (title + width + 2 * margin > options_.width) baseline += 2.2 * size;
  DrawLegend(legend_, options_.width - margin - width, baseline, 0.85 * size, image);
}

absl::Status Studio::Prepare(Stand stand) {
  std::vector<Vec3> framed = survey_.points;
  const std::vector<Vec3> props = PropPointsNear(options_.props, framed);
  framed.insert(framed.end(), props.begin(), props.end());
  CameraOptions look = options_.camera;
  if (stand == Stand::kTurntable) {
    CLEAVE_ASSIGN_OR_RETURN(const Camera still, FrameCamera(framed, 1, look));
    framed = TurnedAround(framed, still, kFramedTurns);
    look.up = still.ground_normal;
    if (!look.elevation) look.elevation = Elevation(still);
  }
  CLEAVE_ASSIGN_OR_RETURN(const double natural, NaturalAspect(framed, look));
  height_ = options_.height > 0 ? options_.height
                                : std::clamp(Round(options_.width / natural), 16, kMaxImageSide);
  CLEAVE_ASSIGN_OR_RETURN(camera_, FrameCamera(framed, aspect(), look));
  const size_t count = survey_.times.size();
  if (count > 1) {
    step_ = (survey_.times.back() - survey_.times.front()) / static_cast<double>(count - 1);
  }
  style_.color_by = options_.color_by;
  style_.samples = options_.samples;
  const auto looks = options_.regions.empty() ? LooksOf(mesh_) : options_.regions;
  for (const auto& [region, region_look] : looks) style_.region_slots[region] = region_look.slot;
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
    case ColorBy::kDamage:
      legend_.map_title = "broken edges of the tets";
      legend_.map_low = "0";
      legend_.map_high = "100 %";
      break;
    case ColorBy::kImpurity:
      legend_.swatches = {
          {"pure", ImpurityColor(0)},
          {absl::StrFormat("potency %.3g", Worst(options_.node_potencies)), ImpurityColor(1)}};
      break;
    case ColorBy::kPiece:
      break;  // pieces have no names
  }
  return absl::OkStatus();
}

void Studio::AddSwatches(const std::map<int32_t, RegionLook>& looks) {
  std::set<std::string> named;
  for (const auto& [region, look] : looks) {
    if (!named.insert(look.label).second) continue;
    legend_.swatches.emplace_back(look.label, RegionColor(look.slot));
  }
  if (survey_.broken_edges.back() == 0) {
    if (legend_.swatches.size() == 1) legend_.swatches.clear();  // nothing to tell apart
    return;
  }
  const auto first = std::min_element(looks.begin(), looks.end(), [](const auto& a, const auto& b) {
    return a.second.slot < b.second.slot;
  });
  legend_.swatches.emplace_back("crack", InsideColor(first->second.slot));
}

absl::Status Studio::ChooseStrainLimit() {
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

}  // namespace cleave
