// An XML file with locations for messages: every error names file, line and path of the element.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/number_text.h"
#include "geom/base/vec3.h"
#include "geom/model/nurbs_form.h"

namespace pugi {
class xml_document;
class xml_node;
}  // namespace pugi

namespace sterna {

class XmlFile {
 public:
  /// \throws Error(file_not_found, file_malformed) with line and column of the XML syntax error
  explicit XmlFile(const std::filesystem::path& path);
  ~XmlFile();
  XmlFile(const XmlFile&) = delete;
  XmlFile& operator=(const XmlFile&) = delete;

  pugi::xml_node root() const;
  /// Returns "line 12, /Assembly/BodySkeleton[Fuselage]/BodyFrame[FrameX0]"; elements by name or uID, else by their index among equal elements.
  std::string location(const pugi::xml_node& node) const;
  /// \throws Error(file_malformed)
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& problem, const std::string& hint = {}) const;
  /// Adds "line 12, /path: text" to the messages, without duplicates.
  void report(const pugi::xml_node& node, const std::string& text);
  std::vector<std::string>& messages() { return messages_; }

  std::string text(const pugi::xml_node& node, const char* attribute, std::string_view fallback = {}) const;
  /// Returns an attribute that must exist.
  /// \throws Error(file_malformed)
  std::string required_text(const pugi::xml_node& node, const char* attribute) const;
  double number(const pugi::xml_node& node, const char* attribute) const;
  double number(const pugi::xml_node& node, const char* attribute, double fallback) const;
  std::optional<double> optional_number(const pugi::xml_node& node, const char* attribute) const;
  std::int64_t integer(const pugi::xml_node& node, const char* attribute, std::int64_t fallback) const;
  /// Returns true for "true", false for "false"; any other value is reported and counts as false.
  bool boolean(const pugi::xml_node& node, const char* attribute, bool fallback);
  /// Returns the three numbers of an attribute.
  /// \throws Error(file_malformed)
  Vec3 vector(const pugi::xml_node& node, const char* attribute) const;
  Vec3 vector(const pugi::xml_node& node, const char* attribute, const Vec3& fallback) const;
  /// Returns all numbers of a text, separated by blanks, line ends or ';'.
  /// \throws Error(file_malformed) naming the first word that is not a finite number
  std::vector<double> numbers(const pugi::xml_node& node, std::string_view text) const;
  /// Returns the text of an element and its CDATA sections.
  static std::string content(const pugi::xml_node& node);
  /// Returns the numbers of an element as pairs.
  /// \throws Error(file_malformed) if their number is odd
  std::vector<Uv> pairs(const pugi::xml_node& node) const;

  /// Returns the number in the text of a child element, or `fallback` if there is no such child.
  /// \throws Error(file_malformed)
  double child_number(const pugi::xml_node& node, const char* child, double fallback) const;
  double required_child_number(const pugi::xml_node& node, const char* child) const;
  /// Returns the text of a child, without surrounding blanks; empty if there is no such child.
  static std::string child_text(const pugi::xml_node& node, const char* child);

  /// Reports every attribute and child element that is in none of the lists (names separated by blanks).
  void warn_unknown(const pugi::xml_node& node, std::string_view attributes, std::initializer_list<std::string_view> children);
  void warn_unknown(const pugi::xml_node& node, std::string_view attributes, std::string_view children) { warn_unknown(node, attributes, {children}); }

 private:
  std::filesystem::path path_;
  std::string bytes_;
  std::unique_ptr<pugi::xml_document> document_;
  std::vector<std::string> messages_;
};

/// Returns `text` as a finite number; empty if it is not a finite number.
std::optional<double> parse_number(std::string_view text);

}  // namespace sterna
