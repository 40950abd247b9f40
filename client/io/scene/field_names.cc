#include "client/io/scene/field_names.h"

#include <algorithm>
#include <numeric>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace cleave {
namespace {

// Longer names are no misspelling of ours, and the distance takes quadratic time.
constexpr size_t kMaxNameBytes = 80;

// Insertions, deletions, changes and swaps of neighbours that turn `a` into `b` (optimal string
// alignment).
size_t EditDistance(absl::string_view a, absl::string_view b) {
  std::vector<size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

// "MeshResolution" -> "mesh resolution".
std::string Words(absl::string_view camel_case) {
  std::string words;
  for (const char letter : camel_case) {
    if (absl::ascii_isupper(static_cast<unsigned char>(letter)) && !words.empty())
      words.push_back(' ');
    words.push_back(absl::ascii_tolower(static_cast<unsigned char>(letter)));
  }
  return words;
}

std::string Shortened(absl::string_view name) {
  if (name.size() <= kMaxNameBytes) return std::string(name);
  return absl::StrCat(name.substr(0, kMaxNameBytes), "...");
}

std::string Advice(absl::string_view name, const std::vector<std::string>& candidates) {
  const std::string nearest = NearestName(name, candidates);
  if (!nearest.empty()) return absl::StrCat("; did you mean \"", nearest, "\"?");
  return absl::StrCat("; there are: ", absl::StrJoin(candidates, ", "));
}

}  // namespace

std::string NearestName(absl::string_view name, const std::vector<std::string>& candidates) {
  if (name.empty() || name.size() > kMaxNameBytes) return "";
  const std::string wanted = absl::AsciiStrToLower(name);
  std::string nearest;
  size_t nearest_distance = std::max<size_t>(1, wanted.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::string lower = absl::AsciiStrToLower(candidate);
    if (absl::EndsWith(lower, absl::StrCat("_", wanted))) return candidate;
    // A part left out or added counts as one slip: modulus, youngs_modulus_pa.
    const bool part = wanted.size() >= 4 && lower.size() >= 4 &&
                      (absl::StrContains(lower, wanted) || absl::StrContains(wanted, lower));
    const size_t distance = part ? 1 : EditDistance(wanted, lower);
    if (distance < nearest_distance) {
      nearest = candidate;
      nearest_distance = distance;
    }
  }
  return nearest;
}

std::string UnknownFieldText(const google::protobuf::Descriptor& message, absl::string_view name) {
  std::vector<std::string> candidates;
  for (int i = 0; i < message.field_count(); ++i) candidates.push_back(message.field(i)->name());
  // "noise field field" reads like a slip.
  const std::string words = Words(message.name());
  return absl::StrCat(words, absl::EndsWith(words, " field") ? " \"" : " field \"", Shortened(name),
                      "\" is unknown", Advice(name, candidates));
}

std::string UnknownValueText(const google::protobuf::EnumDescriptor& type, absl::string_view name) {
  std::vector<std::string> candidates;
  for (int i = 0; i < type.value_count(); ++i) candidates.push_back(type.value(i)->name());
  return absl::StrCat("\"", Shortened(name), "\" is unknown", Advice(name, candidates));
}

}  // namespace cleave
