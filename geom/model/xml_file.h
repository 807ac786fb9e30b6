// An XML file with places: every complaint names file, line and path of the element.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/vec3.h"
#include "geom/model/nurbs_form.h"

namespace pugi {
class xml_document;
class xml_node;
}  // namespace pugi

namespace sterna {

class XmlFile {
 public:
  /// \throws Error(file_not_found, file_malformed) with line and column of what is not XML
  explicit XmlFile(const std::filesystem::path& path);
  ~XmlFile();
  XmlFile(const XmlFile&) = delete;
  XmlFile& operator=(const XmlFile&) = delete;

  pugi::xml_node root() const;
  /// "line 12, /Assembly/BodySkeleton[Fuselage]/BodyFrame[FrameX0]"; elements by name or uID, else by their place among equals.
  std::string place(const pugi::xml_node& node) const;
  /// \throws Error(file_malformed)
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& problem, const std::string& hint = {}) const;
  /// Adds "line 12, /path: text" to the messages, once.
  void tell(const pugi::xml_node& node, const std::string& text);
  std::vector<std::string>& messages() { return messages_; }

  std::string text(const pugi::xml_node& node, const char* attribute, std::string_view fallback = {}) const;
  /// Attribute that must be there.
  /// \throws Error(file_malformed)
  std::string required_text(const pugi::xml_node& node, const char* attribute) const;
  double number(const pugi::xml_node& node, const char* attribute) const;
  double number(const pugi::xml_node& node, const char* attribute, double fallback) const;
  std::optional<double> optional_number(const pugi::xml_node& node, const char* attribute) const;
  std::int64_t integer(const pugi::xml_node& node, const char* attribute, std::int64_t fallback) const;
  /// "true" or "false"; anything else is told and counts as false.
  bool boolean(const pugi::xml_node& node, const char* attribute, bool fallback);
  /// Three numbers of an attribute.
  /// \throws Error(file_malformed)
  Vec3 vector(const pugi::xml_node& node, const char* attribute) const;
  Vec3 vector(const pugi::xml_node& node, const char* attribute, const Vec3& fallback) const;
  /// All numbers of a text, separated by blanks, line ends or ';'.
  /// \throws Error(file_malformed) naming the first word that is no finite number
  std::vector<double> numbers(const pugi::xml_node& node, std::string_view text) const;
  /// Text of an element and its CDATA sections.
  static std::string content(const pugi::xml_node& node);
  /// The same as pairs.
  /// \throws Error(file_malformed) when their number is odd
  std::vector<Uv> pairs(const pugi::xml_node& node) const;

  /// Number in the text of a child element, `fallback` where there is no such child.
  /// \throws Error(file_malformed)
  double child_number(const pugi::xml_node& node, const char* child, double fallback) const;
  double required_child_number(const pugi::xml_node& node, const char* child) const;
  /// Text of a child without blanks around it; empty where there is none.
  static std::string child_text(const pugi::xml_node& node, const char* child);

  /// Tells every attribute and child element that is in none of the lists (names separated by blanks).
  void warn_unknown(const pugi::xml_node& node, std::string_view attributes, std::initializer_list<std::string_view> children);
  void warn_unknown(const pugi::xml_node& node, std::string_view attributes, std::string_view children) { warn_unknown(node, attributes, {children}); }

 private:
  std::filesystem::path path_;
  std::string bytes_;
  std::unique_ptr<pugi::xml_document> document_;
  std::vector<std::string> messages_;
};

/// Shortest text that reads back as the same number, independent of the locale.
std::string exact_text(double value);
/// `text` as a finite number; nothing when it is none.
std::optional<double> parse_number(std::string_view text);

}  // namespace sterna
