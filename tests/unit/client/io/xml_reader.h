#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_XML_READER_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_XML_READER_H_

#include <cctype>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace cleave::testing {

// An element with its attributes, text and children, in document order.
struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;
  std::vector<XmlElement> children;

  const XmlElement* Child(absl::string_view wanted) const {
    for (const XmlElement& child : children) {
      if (child.name == wanted) return &child;
    }
    return nullptr;
  }
  // All elements below this one that bear the name.
  std::vector<const XmlElement*> All(absl::string_view wanted) const {
    std::vector<const XmlElement*> found;
    for (const XmlElement& child : children) {
      if (child.name == wanted) found.push_back(&child);
      for (const XmlElement* deeper : child.All(wanted)) found.push_back(deeper);
    }
    return found;
  }
};

// A strict reader of the XML that Cleave writes: one root, every tag closed in order, attributes
// quoted and named once, no stray '<', '&' or control character. Entities stay as they are.
class XmlReader {
 public:
  static absl::StatusOr<XmlElement> Read(absl::string_view text) {
    XmlReader reader(text);
    XmlElement root;
    reader.SkipProlog();
    if (!reader.ReadElement(root)) {
      return absl::DataLossError(absl::StrCat(reader.fault_, " at byte ", reader.place_));
    }
    reader.SkipSpace();
    if (reader.place_ != text.size()) return absl::DataLossError("text after the root element");
    return root;
  }

 private:
  explicit XmlReader(absl::string_view text) : text_(text) {}

  bool Fail(absl::string_view fault) {
    if (fault_.empty()) fault_ = std::string(fault);
    return false;
  }
  bool Take(absl::string_view token) {
    if (text_.substr(place_, token.size()) != token) return false;
    place_ += token.size();
    return true;
  }
  void SkipSpace() {
    while (place_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[place_])) != 0) {
      ++place_;
    }
  }
  bool SkipComment() {
    if (!Take("<!--")) return false;
    const size_t end = text_.find("--", place_);
    place_ = end == absl::string_view::npos ? text_.size() : end;
    return Take("-->") || Fail("bad comment");
  }
  void SkipProlog() {
    if (Take("<?xml")) {
      const size_t end = text_.find("?>", place_);
      place_ = end == absl::string_view::npos ? text_.size() : end + 2;
    }
    do SkipSpace();
    while (SkipComment());
  }
  std::string ReadName() {
    const size_t begin = place_;
    while (place_ < text_.size()) {
      const char c = text_[place_];
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-' && c != ':') {
        break;
      }
      ++place_;
    }
    return std::string(text_.substr(begin, place_ - begin));
  }
  bool ReadAttributes(XmlElement& element) {
    while (true) {
      const size_t before = place_;
      SkipSpace();
      if (place_ >= text_.size()) return Fail("end inside a tag");
      if (text_[place_] == '>' || text_[place_] == '/') return true;
      if (before == place_) return Fail("no space before an attribute");
      const std::string name = ReadName();
      if (name.empty() || !Take("=\"")) return Fail("bad attribute");
      const size_t end = text_.find('"', place_);
      if (end == absl::string_view::npos) return Fail("open quote");
      const absl::string_view value = text_.substr(place_, end - place_);
      if (value.find('<') != absl::string_view::npos) return Fail("'<' in an attribute");
      if (!element.attributes.emplace(name, std::string(value)).second) {
        return Fail("attribute named twice");
      }
      place_ = end + 1;
    }
  }
  bool CheckText(absl::string_view text) {
    for (size_t i = 0; i < text.size(); ++i) {
      const auto c = static_cast<unsigned char>(text[i]);
      if (c < 32 && c != '\n' && c != '\t' && c != '\r') return Fail("control character");
      if (c == '&' && text.find(';', i) == absl::string_view::npos) return Fail("bare '&'");
    }
    return true;
  }
  bool ReadElement(XmlElement& element) {
    if (!Take("<")) return Fail("no element");
    element.name = ReadName();
    if (element.name.empty()) return Fail("no tag name");
    if (!ReadAttributes(element)) return false;
    if (Take("/>")) return true;
    if (!Take(">")) return Fail("bad tag");
    while (place_ < text_.size()) {
      const size_t next = text_.find('<', place_);
      if (next == absl::string_view::npos) break;
      const absl::string_view text = text_.substr(place_, next - place_);
      if (!CheckText(text)) return false;
      absl::StrAppend(&element.text, text);
      place_ = next;
      if (SkipComment()) continue;
      if (Take("</")) {
        return (ReadName() == element.name && Take(">")) || Fail("wrong closing tag");
      }
      if (!ReadElement(element.children.emplace_back())) return false;
    }
    return Fail("element never closed");
  }

  absl::string_view text_;
  size_t place_ = 0;
  std::string fault_;
};

}  // namespace cleave::testing

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_XML_READER_H_
