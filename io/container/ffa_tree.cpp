#include "io/container/ffa_tree.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

#include "io/input/byte_reader.h"
#include "io/input/text_scanner.h"

namespace sterna::io {
namespace {

constexpr int k_deepest = 32;  // levels of nodes; a mesh has 5
constexpr std::int32_t k_ffa_header_bytes = 32;
constexpr std::string_view k_version_2 = "FFA-format-v2";
constexpr std::size_t k_version_2_bytes = 32;

std::string without_blanks(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
  return std::string(text);
}

template <class T>
T number_at(std::string_view bytes, std::size_t at, std::endian order) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace

std::size_t ffa_value_size(char type) {
  switch (type) {
    case 'A': return 1;
    case 'I':
    case 'R':
    case 'B': return 4;
    case 'J':
    case 'D':
    case 'C': return 8;
    case 'S':
    case 'Z': return 16;
    case 'L': return 72;
    default: return 0;
  }
}

std::int64_t FfaNode::integer(std::uint64_t row, std::uint64_t column) const {
  const std::uint64_t i = location_of(row, column);
  if (is_ascii_) return integers_[i];
  return type == 'J' ? number_at<std::int64_t>(buffer_->text(), data_ + i * 8, order_) : number_at<std::int32_t>(buffer_->text(), data_ + i * 4, order_);
}

double FfaNode::real(std::uint64_t row, std::uint64_t column) const {
  if (is_integer()) return static_cast<double>(integer(row, column));
  const std::uint64_t i = location_of(row, column);
  if (is_ascii_) return reals_[i];
  return type == 'D' ? number_at<double>(buffer_->text(), data_ + i * 8, order_)
                     : static_cast<double>(number_at<float>(buffer_->text(), data_ + i * 4, order_));
}

std::string FfaNode::text() const { return is_ascii_ ? text_ : without_blanks(buffer_->text().substr(data_, ffa_value_size(type))); }

const FfaNode* FfaNode::find(std::string_view child) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const FfaNode& node) { return node.name == child; });
  return found == children.end() ? nullptr : &*found;
}

const FfaNode& FfaNode::at(std::string_view child) const {
  const FfaNode* const found = find(child);
  if (!found) fail("found no \"" + std::string(child) + "\" below this node");
  return *found;
}

std::string FfaNode::location() const {
  if (!is_ascii_) return "byte " + std::to_string(begin_);
  const std::string_view before = buffer_->text().substr(0, begin_);
  return "line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n'));
}

void FfaNode::fail(const std::string& problem) const { throw_malformed(buffer_->source, location(), "node " + quoted_excerpt(name) + ": " + problem); }

/// Pre-order parser of nodes. A file of n bytes has at most n / 32 nodes, so memory is proportional to the file size.
class FfaParser {
 public:
  explicit FfaParser(const FileBuffer& buffer) : buffer_(buffer), bytes_(buffer, std::endian::big), scanner_(buffer, {.comment = '*'}) {}

  FfaNode parse() {
    const std::string_view text = buffer_.text();
    if (text.starts_with(k_version_2)) {
      version_ = 2;
      bytes_.require(k_version_2_bytes, 1, "the header of version 2");
      bytes_.skip(k_version_2_bytes);
    } else if (text.size() >= 4 && number_at<std::int32_t>(text, 0, std::endian::big) == k_ffa_header_bytes) {
      version_ = 1;
    } else if (text.size() >= 4 && number_at<std::int32_t>(text, 0, std::endian::little) == k_ffa_header_bytes) {
      version_ = 1;
      bytes_ = ByteReader(buffer_, std::endian::little);
    } else {
      version_ = 0;
      scanner_.set_line_bound(false);
    }
    FfaNode root = node(0);
    if (version_ == 0 ? !scanner_.at_end() : bytes_.remaining() > 0) root.fail("found data after the end of the tree");
    return root;
  }

 private:
  FfaNode node(int depth) {
    FfaNode result;
    result.buffer_ = &buffer_;
    result.begin_ = version_ == 0 ? scanner_.offset() : bytes_.offset();
    result.order_ = bytes_.order();
    result.is_ascii_ = version_ == 0;
    const std::uint64_t n_children = version_ == 0 ? ascii_header(result) : version_ == 1 ? header_1(result) : header_2(result);
    if (depth > k_deepest) result.fail("nodes are nested deeper than " + std::to_string(k_deepest));
    if (result.n_values() > 0 && ffa_value_size(result.type) == 0) result.fail("found values of the type " + quoted_excerpt(std::string(1, result.type)));
    if (result.n_values() > 0) version_ == 0 ? ascii_data(result) : binary_data(result);
    for (std::uint64_t i = 0; i < n_children; ++i) result.children.push_back(node(depth + 1));
    return result;
  }

  std::string chars(std::size_t n, std::string_view expected) {
    bytes_.require(n, 1, expected);
    const std::string text = without_blanks(buffer_.text().substr(bytes_.offset(), n));
    bytes_.skip(n);
    return text;
  }

  void take_shape(FfaNode& node, const std::string& type, std::int64_t columns, std::int64_t rows, std::int64_t children) const {
    node.type = type.empty() ? 'N' : type[0];
    if (columns < 0 || rows < 0 || children < 0)
      node.fail("found " + std::to_string(columns) + " columns, " + std::to_string(rows) + " rows, " + std::to_string(children) +
                " children, expected none below 0");
    constexpr std::uint64_t k_most_values = std::uint64_t{1} << 56;
    if (rows > 0 && static_cast<std::uint64_t>(columns) > k_most_values / static_cast<std::uint64_t>(rows))
      node.fail("found " + std::to_string(columns) + " columns of " + std::to_string(rows) + " rows");
    node.n_columns = static_cast<std::uint64_t>(columns);
    node.n_rows = static_cast<std::uint64_t>(rows);
  }

  void marker(std::int64_t expected, std::string_view what) {
    const std::size_t at = bytes_.offset();
    const std::int32_t found = bytes_.read<std::int32_t>(what);
    if (found < 0) throw_unsupported(buffer_.source, "a record of 2 GiB or more at byte " + std::to_string(at), "write the file in version 2");
    if (found != expected)
      throw_malformed(buffer_.source, "byte " + std::to_string(at),
                      "found " + std::to_string(found) + " as the length of a record, expected " + std::to_string(expected) + " (" + std::string(what) + ")");
  }

  std::uint64_t header_1(FfaNode& node) {
    marker(k_ffa_header_bytes, "the header of a node");
    node.name = chars(16, "the name of a node");
    const std::string type = chars(4, "the type of a node");
    const auto columns = bytes_.read<std::int32_t>("the number of columns"), rows = bytes_.read<std::int32_t>("the number of rows");
    const auto children = bytes_.read<std::int32_t>("the number of children");
    take_shape(node, type, columns, rows, children);
    marker(k_ffa_header_bytes, "the end of a node's header");
    return static_cast<std::uint64_t>(children);
  }

  std::uint64_t header_2(FfaNode& node) {
    node.name = chars(16, "the name of a node");
    const std::string type = chars(4, "the type of a node");
    const auto columns = bytes_.read<std::int64_t>("the number of columns"), rows = bytes_.read<std::int64_t>("the number of rows");
    const auto children = bytes_.read<std::int64_t>("the number of children");
    take_shape(node, type, columns, rows, children);
    return static_cast<std::uint64_t>(children);
  }

  void binary_data(FfaNode& node) {
    const std::size_t size = ffa_value_size(node.type);
    const std::uint64_t n = node.n_values();
    if (version_ == 2) {
      const std::size_t at = bytes_.offset();
      const auto count = bytes_.read<std::int64_t>("the number of values");  // number of elements or of bytes: writers differ
      if (count != static_cast<std::int64_t>(n) && count != static_cast<std::int64_t>(n * size))
        throw_malformed(buffer_.source, "byte " + std::to_string(at),
                        "found " + std::to_string(count) + " as the number of values, expected " + std::to_string(n));
    }
    const auto n_bytes = static_cast<std::int64_t>(n * size);
    if (version_ == 1) marker(n_bytes, "the values of \"" + node.name + "\"");
    bytes_.require(n, size, "the values of \"" + node.name + "\"");
    node.data_ = bytes_.offset();
    bytes_.skip(n * size);
    if (version_ == 1) marker(n_bytes, "the end of the values of \"" + node.name + "\"");
  }

  /// Reads "name, TYPE, columns, rows, children", separated by commas or blanks.
  std::uint64_t ascii_header(FfaNode& node) {
    if (scanner_.at_end()) scanner_.fail_expected("a node: name, type, columns, rows, children");
    node.begin_ = scanner_.offset();
    std::string line(scanner_.rest_of_line());
    std::replace(line.begin(), line.end(), ',', ' ');
    std::vector<std::string> fields;
    for (std::size_t at = line.find_first_not_of(" \t"); at != std::string::npos && fields.size() < 6; at = line.find_first_not_of(" \t", at)) {
      const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
      fields.push_back(line.substr(at, end - at));
      at = end;
    }
    const auto number = [&](std::size_t k) -> std::int64_t {
      const std::string& field = fields[k];
      if (field.empty() || field.size() > 18 || !std::all_of(field.begin(), field.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
        scanner_.fail("found " + quoted_excerpt(line) + ", expected a node: name, type, columns, rows, children");
      return std::stoll(field);
    };
    if (fields.size() != 5) scanner_.fail("found " + quoted_excerpt(line) + ", expected a node: name, type, columns, rows, children");
    node.name = fields[0];
    take_shape(node, fields[1], number(2), number(3), number(4));
    return static_cast<std::uint64_t>(number(4));
  }

  void ascii_data(FfaNode& node) {
    const std::uint64_t n = node.n_values();
    if (n > scanner_.remaining())
      scanner_.fail("found " + std::to_string(n) + " values announced, but " + std::to_string(scanner_.remaining()) + " bytes left in the file");
    if (node.is_text() || node.type == 'A') {
      for (std::uint64_t i = 0; i < n; ++i) {
        const std::string value = quoted();
        if (i == 0) node.text_ = value;
      }
    } else if (node.is_integer()) {
      node.integers_.resize(n);
      for (std::int64_t& value : node.integers_) value = scanner_.integer("a value of \"" + node.name + "\"");
    } else {
      node.reals_.resize(n);
      for (double& value : node.reals_) value = scanner_.real("a value of \"" + node.name + "\"");
    }
    if (scanner_.at_line_end()) scanner_.next_line();
  }

  /// Reads 'text on one line'.
  std::string quoted() {
    if (scanner_.at_end()) scanner_.fail_expected("a string in single quotes");
    const std::string line(scanner_.rest_of_line());
    const std::size_t end = line.size() < 2 || line[0] != '\'' ? std::string::npos : line.rfind('\'');
    if (end == std::string::npos || end == 0) scanner_.fail("found " + quoted_excerpt(line) + ", expected a string in single quotes");
    return without_blanks(std::string_view(line).substr(1, end - 1));
  }

  const FileBuffer& buffer_;
  ByteReader bytes_;
  TextScanner scanner_;
  int version_ = 1;  ///< 0 = text
};

FfaNode parse_ffa(Borrowed<const FileBuffer> buffer) { return FfaParser(buffer).parse(); }

}  // namespace sterna::io
