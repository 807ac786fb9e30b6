#include "geom/model/xml_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include <pugixml.hpp>

#include "geom/base/error.h"

namespace sterna {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool is_listed(std::string_view names, std::string_view name) {
  for (std::size_t at = names.find(name); at != std::string_view::npos; at = names.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || names[at - 1] == ' ') && (end == names.size() || names[end] == ' ')) return true;
  }
  return false;
}

/// Returns line and column of a byte, counted from 1.
std::pair<std::ptrdiff_t, std::ptrdiff_t> line_and_column(const std::string& bytes, std::ptrdiff_t offset) {
  const auto end = bytes.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(bytes));
  const auto line = std::count(bytes.begin(), end, '\n');
  const auto last = std::find(std::make_reverse_iterator(end), bytes.rend(), '\n');
  return {line + 1, (end - last.base()) + 1};
}

std::string label_of(const pugi::xml_node& node) {
  for (const char* attribute : {"name", "uID", "id"})
    if (const pugi::xml_attribute a = node.attribute(attribute); a && *a.value()) return std::string("[") + a.value() + "]";
  int index = 1, n = 0;
  for (const pugi::xml_node sibling : node.parent().children(node.name())) {
    ++n;
    if (sibling == node) index = n;
  }
  return n > 1 ? "[" + std::to_string(index) + "]" : "";
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

XmlFile::XmlFile(const std::filesystem::path& path) : path_(path), document_(std::make_unique<pugi::xml_document>()) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error({.code = ErrorCode::file_not_found, .attempted = "reading " + path.string(), .problem = "the file cannot be opened"});
  bytes_.assign(std::istreambuf_iterator<char>(in), {});
  const pugi::xml_parse_result result = document_->load_buffer(bytes_.data(), bytes_.size());
  if (!result) {
    const auto [line, column] = line_and_column(bytes_, result.offset);
    throw Error({.code = ErrorCode::file_malformed,
                 .attempted = "reading " + path.string(),
                 .problem = "line " + std::to_string(line) + ", column " + std::to_string(column) + ": the file is not valid XML: " + result.description()});
  }
}

XmlFile::~XmlFile() = default;

pugi::xml_node XmlFile::root() const { return document_->document_element(); }

std::string XmlFile::location(const pugi::xml_node& node) const {
  std::string path;
  for (pugi::xml_node at = node; at.type() == pugi::node_element; at = at.parent()) path = "/" + (at.name() + label_of(at)) + path;
  return "line " + std::to_string(line_and_column(bytes_, node.offset_debug()).first) + ", " + path;
}

void XmlFile::fail(const pugi::xml_node& node, const std::string& problem, const std::string& hint) const {
  throw Error({.code = ErrorCode::file_malformed, .attempted = "reading " + path_.string(), .problem = location(node) + ": " + problem, .hint = hint});
}

void XmlFile::report(const pugi::xml_node& node, const std::string& text) {
  std::string message = location(node) + ": " + text;
  if (std::find(messages_.begin(), messages_.end(), message) == messages_.end()) messages_.push_back(std::move(message));
}

std::string XmlFile::text(const pugi::xml_node& node, const char* attribute, std::string_view fallback) const {
  const pugi::xml_attribute a = node.attribute(attribute);
  return a ? std::string(a.value()) : std::string(fallback);
}

std::string XmlFile::required_text(const pugi::xml_node& node, const char* attribute) const {
  const pugi::xml_attribute a = node.attribute(attribute);
  if (!a || !*a.value()) fail(node, std::string("attribute '") + attribute + "' is missing");
  return a.value();
}

std::optional<double> XmlFile::optional_number(const pugi::xml_node& node, const char* attribute) const {
  const pugi::xml_attribute a = node.attribute(attribute);
  if (!a) return std::nullopt;
  const std::optional<double> value = parse_number(a.value());
  if (!value) fail(node, std::string("attribute '") + attribute + "' is '" + a.value() + "', not a finite number");
  return value;
}

double XmlFile::number(const pugi::xml_node& node, const char* attribute) const {
  const std::optional<double> value = optional_number(node, attribute);
  if (!value) fail(node, std::string("attribute '") + attribute + "' is missing");
  return *value;
}

double XmlFile::number(const pugi::xml_node& node, const char* attribute, double fallback) const { return optional_number(node, attribute).value_or(fallback); }

std::int64_t XmlFile::integer(const pugi::xml_node& node, const char* attribute, std::int64_t fallback) const {
  const std::optional<double> value = optional_number(node, attribute);
  if (!value) return fallback;
  constexpr double k_largest = 9007199254740992.0;  // 2^53: above it a double cannot represent every integer
  if (std::floor(*value) != *value || std::abs(*value) > k_largest)
    fail(node, std::string("attribute '") + attribute + "' is " + exact_text(*value) + ", not an integer");
  return static_cast<std::int64_t>(*value);
}

bool XmlFile::boolean(const pugi::xml_node& node, const char* attribute, bool fallback) {
  const pugi::xml_attribute a = node.attribute(attribute);
  if (!a) return fallback;
  const std::string_view value = a.value();
  if (value == "true" || value == "1") return true;
  if (value != "false" && value != "0")
    report(node, std::string("attribute '") + attribute + "' is '" + a.value() + "', neither true nor false; false is assumed");
  return false;
}

Vec3 XmlFile::vector(const pugi::xml_node& node, const char* attribute) const {
  const std::string value = required_text(node, attribute);
  const std::vector<double> n = numbers(node, value);
  if (n.size() != 3) fail(node, std::string("attribute '") + attribute + "' has " + std::to_string(n.size()) + " numbers instead of 3: '" + value + "'");
  return {n[0], n[1], n[2]};
}

Vec3 XmlFile::vector(const pugi::xml_node& node, const char* attribute, const Vec3& fallback) const {
  return node.attribute(attribute) ? vector(node, attribute) : fallback;
}

std::vector<double> XmlFile::numbers(const pugi::xml_node& node, std::string_view text) const {
  const auto is_separator = [](char c) { return is_blank(c) || c == ';'; };
  std::vector<double> values;
  for (std::size_t at = 0; at < text.size();) {
    if (is_separator(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && !is_separator(text[end])) ++end;
    const std::string_view word = text.substr(at, end - at);
    const std::optional<double> value = parse_number(word);
    if (!value) fail(node, "'" + std::string(word.substr(0, 40)) + "' is not a finite number (number " + std::to_string(values.size() + 1) + " of the list)");
    values.push_back(*value);
    at = end;
  }
  return values;
}

std::string XmlFile::content(const pugi::xml_node& node) {
  std::string all;
  for (const pugi::xml_node child : node.children())
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) (all += child.value()) += ' ';
  return all;
}

std::string XmlFile::child_text(const pugi::xml_node& node, const char* child) {
  std::string text = content(node.child(child));
  const auto is_ink = [](char c) { return !is_blank(c); };
  text.erase(std::find_if(text.rbegin(), text.rend(), is_ink).base(), text.end());
  text.erase(text.begin(), std::find_if(text.begin(), text.end(), is_ink));
  return text;
}

double XmlFile::child_number(const pugi::xml_node& node, const char* child, double fallback) const {
  const pugi::xml_node at = node.child(child);
  if (!at) return fallback;
  const std::string text = child_text(node, child);
  const std::optional<double> value = parse_number(text);
  if (!value) fail(at, "'" + text.substr(0, 40) + "' is not a finite number");
  return *value;
}

double XmlFile::required_child_number(const pugi::xml_node& node, const char* child) const {
  if (!node.child(child)) fail(node, std::string("the element '") + child + "' is missing");
  return child_number(node, child, 0.0);
}

std::vector<Uv> XmlFile::pairs(const pugi::xml_node& node) const {
  const std::vector<double> values = numbers(node, content(node));
  if (values.size() % 2 != 0) fail(node, "a list of " + std::to_string(values.size()) + " numbers cannot form pairs");
  std::vector<Uv> pairs(values.size() / 2);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {values[2 * i], values[2 * i + 1]};
  return pairs;
}

void XmlFile::warn_unknown(const pugi::xml_node& node, std::string_view attributes, std::initializer_list<std::string_view> children) {
  for (const pugi::xml_attribute a : node.attributes())
    if (!is_listed(attributes, a.name())) report(node, std::string("attribute '") + a.name() + "' is not known and was left out");
  for (const pugi::xml_node child : node.children())
    if (child.type() == pugi::node_element &&
        std::none_of(children.begin(), children.end(), [&](std::string_view list) { return is_listed(list, child.name()); }))
      report(child, "this element is not known and was left out");
}

}  // namespace sterna
