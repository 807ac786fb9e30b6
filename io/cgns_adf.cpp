// CGNS nodes in ADF, the older container: fixed headers whose numbers are hexadecimal text (version A) or, for pointers and extents, 64-bit binary (version B of CGNS 4).
// Pointers are a block of 4096 bytes and an offset in it. Based on: the layout of the ADF Library's structures (CGNS, src/adf) and files written by it.
#include <algorithm>
#include <set>

#include "io/cgns_tree.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_block = 4096;
constexpr std::uint64_t k_file_header = 186;
constexpr std::uint64_t k_free_table = 80;
constexpr std::uint64_t k_node_header = 246;
constexpr std::uint64_t k_max_extents = 12;
constexpr std::uint64_t k_name = 32;
constexpr std::uint64_t k_pointer = 12;
constexpr int k_max_depth = 64;

class AdfContainer : public CgnsContainer {
 public:
  explicit AdfContainer(const FileBuffer& buffer) : buffer_(buffer) {
    if (buffer.bytes.size() < k_file_header) fail(0, "found " + std::to_string(buffer.bytes.size()) + " bytes, expected the " + std::to_string(k_file_header) + " of an ADF file's head");
    const char version = buffer.bytes[25];
    if (version != 'A' && version != 'B') fail(25, "found the ADF version " + quoted_excerpt(buffer.text().substr(25, 6)) + ", expected one of letter A or B");
    is_binary_ = version == 'B';
    const char format = buffer.bytes[100];
    if (format != 'L' && format != 'B') throw_unsupported(buffer.source, "byte 100: numbers of the ADF format " + quoted_excerpt(buffer.text().substr(100, 1)), "convert the file with: cgnsconvert -h old new");
    order_ = format == 'L' ? std::endian::little : std::endian::big;
    require_tag(130, "AdF4");
    root_ = pointer(134);
    end_ = pointer(146);
    if (end_ >= buffer.bytes.size())
      throw_malformed(buffer.source, "byte 146", "the file has " + std::to_string(buffer.bytes.size()) + " bytes, its head says " + std::to_string(end_ + 1), "the file may have been cut short: copy or write it again");
  }

  CgnsNode read_root() override { return node_at(root_, "", 0); }

  NumberArray data(const CgnsNode& node) override {
    NumberArray array{.kind = cgns_kind(buffer_, node), .order = order_, .source = buffer_.source, .where = node.path};
    const std::uint64_t n_extents = hex(node.place + 128, 2);
    if (n_extents > k_max_extents) fail(node.place + 128, "found " + std::to_string(n_extents) + " extents, expected at most 12");
    for (std::uint64_t k = 0; k < n_extents; ++k) array.extents.push_back(wide(node.place + 130 + 8 * k));
    std::uint64_t n_bytes = 0;
    if (__builtin_mul_overflow(n_extents == 0 ? 0 : count_of(array.extents, array.source, array.where), byte_size(array.kind), &n_bytes)) array.fail("the number of bytes does not fit 64 bits");
    const std::uint64_t n_pieces = hex(node.place + 226, 4), at = pointer(node.place + 230);
    if (n_bytes == 0) return array;
    if (n_pieces == 0) array.fail("its " + std::to_string(n_bytes) + " bytes were never written");
    if (n_pieces == 1) {
      const std::string_view piece = data_piece(at);
      if (piece.size() < n_bytes) fail(at, "found " + std::to_string(piece.size()) + " bytes of data, expected " + std::to_string(n_bytes));
      array.bytes = piece.substr(0, n_bytes);
      return array;
    }
    require_tag(at, "DCtb");
    std::vector<char> joined;
    for (std::uint64_t i = 0; i < n_pieces && joined.size() < n_bytes; ++i) {
      const std::string_view piece = data_piece(pointer(at + 16 + 2 * k_pointer * i));
      if (joined.size() + piece.size() > buffer_.bytes.size()) fail(at, "the pieces of data are more than the file");
      joined.insert(joined.end(), piece.begin(), piece.end());
    }
    if (joined.size() < n_bytes) fail(at, "found " + std::to_string(joined.size()) + " bytes of data, expected " + std::to_string(n_bytes));
    joined.resize(n_bytes);
    array.unpacked = std::make_shared<const std::vector<char>>(std::move(joined));
    array.bytes = {array.unpacked->data(), array.unpacked->size()};
    return array;
  }

 private:
  [[noreturn]] void fail(std::uint64_t at, std::string_view problem) const { throw_malformed(buffer_.source, "byte " + std::to_string(at), problem); }

  std::string_view bytes(std::uint64_t at, std::uint64_t n) const {
    const std::uint64_t size = buffer_.bytes.size();
    if (at > size || n > size - at) throw_malformed(buffer_.source, "byte " + std::to_string(at), "the file ends at byte " + std::to_string(size) + ", expected " + std::to_string(n) + " bytes", "the file may have been cut short: copy or write it again");
    return buffer_.text().substr(at, n);
  }
  void require_tag(std::uint64_t at, std::string_view tag) const {
    if (bytes(at, tag.size()) != tag) fail(at, "found " + quoted_excerpt(bytes(at, tag.size())) + ", expected \"" + std::string(tag) + "\"");
  }
  std::uint64_t hex(std::uint64_t at, unsigned n) const {
    std::uint64_t value = 0;
    for (const char c : bytes(at, n)) {
      const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
      if (digit < 0) fail(at, "found " + quoted_excerpt(bytes(at, n)) + ", expected hexadecimal digits");
      value = 16 * value + static_cast<std::uint64_t>(digit);
    }
    return value;
  }
  std::uint64_t binary(std::uint64_t at, unsigned n) const {
    const std::string_view raw = bytes(at, n);
    std::uint64_t value = 0;
    for (unsigned k = 0; k < n; ++k) value |= static_cast<std::uint64_t>(static_cast<unsigned char>(raw[order_ == std::endian::little ? k : n - 1 - k])) << (8 * k);
    return value;
  }
  std::uint64_t wide(std::uint64_t at) const { return is_binary_ ? binary(at, 8) : hex(at, 8); }
  std::uint64_t pointer(std::uint64_t at) const {
    const std::uint64_t block = wide(at), offset = is_binary_ ? binary(at + 8, 4) : hex(at + 8, 4);
    if (block > (std::uint64_t{1} << 50) || offset > k_block) fail(at, "found a pointer to block " + std::to_string(block) + ", offset " + std::to_string(offset));
    return block * k_block + offset;
  }
  std::string text(std::uint64_t at) const {
    std::string_view found = bytes(at, k_name);
    found = found.substr(0, found.find('\0'));
    while (found.ends_with(' ')) found.remove_suffix(1);
    return std::string(found);
  }
  std::string_view data_piece(std::uint64_t at) const {
    require_tag(at, "DaTa");
    const std::uint64_t end = pointer(at + 4);
    if (end < at + 16) fail(at, "found data that ends before it begins");
    require_tag(end, "dEnD");
    return bytes(at + 16, end - at - 16);
  }

  CgnsNode node_at(std::uint64_t at, const std::string& parent_path, int depth) {
    require_tag(at, "NoDe");
    require_tag(at + k_node_header - 4, "TaiL");
    CgnsNode node{.name = text(at + 4), .label = text(at + 36), .type = text(at + 96), .place = at};
    node.path = depth == 0 ? "/" : (parent_path == "/" ? "" : parent_path) + "/" + node.name;
    if (depth > k_max_depth) throw_malformed(buffer_.source, node.path, "nodes are nested more than " + std::to_string(k_max_depth) + " deep");
    if (!seen_.insert(at).second) throw_malformed(buffer_.source, node.path, "the node has two parents");
    const std::uint64_t n_children = hex(at + 68, 8);
    if (n_children == 0) return node;
    const std::uint64_t table = pointer(at + 84);
    require_tag(table, "SNTb");
    if (n_children > buffer_.bytes.size() / k_node_header) fail(at + 68, "found " + std::to_string(n_children) + " children, more than the file can hold");
    for (std::uint64_t i = 0; i < n_children; ++i) node.children.push_back(node_at(pointer(table + 16 + 44 * i + k_name), node.path, depth + 1));
    return node;
  }

  const FileBuffer& buffer_;
  std::endian order_ = std::endian::little;
  bool is_binary_ = false;
  std::uint64_t root_ = 0, end_ = 0;
  std::set<std::uint64_t> seen_;
};

// ---- writing (version A: what every library reads)

std::string hex_text(std::uint64_t value, unsigned n) {
  std::string text(n, '0');
  for (unsigned k = n; k-- > 0; value >>= 4) text[k] = "0123456789ABCDEF"[value & 15];
  return text;
}
std::string pointer_text(std::uint64_t place) { return hex_text(place / k_block, 8) + hex_text(place % k_block, 4); }
const std::string k_no_pointer = "000000001000";  // block 0, offset 4096
std::string padded(std::string text, std::size_t n) {
  text.resize(n, ' ');
  return text;
}

/// Places first, then bytes; node header, table of children and data of a node follow each other, then its children.
class AdfWriter {
 public:
  std::vector<OutputSection> sections(const CgnsOutputNode& root) {
    place(root);
    const std::uint64_t file_end = end_ - 1;
    std::string date = padded("Thu Jan  1 00:00:00 1970", 28);  // the same bytes each time
    text_ = "\xc0\xa8\xa3\xa9" "ADF Database Version A02011>AdF0" + date + "AdF1" + date + "AdF2LBAdF3" + "010204080408080808080808" + "AdF4" + pointer_text(k_file_header + k_free_table) +
            pointer_text(file_end) + pointer_text(k_file_header) + k_no_pointer + "AdF5" + "fCbt";
    for (int k = 0; k < 6; ++k) text_ += k_no_pointer;
    text_ += "Fcte";
    std::size_t next = 0;
    put(root, next);
    text_ += std::string((k_block - end_ % k_block) % k_block, ' ');
    flush();
    return std::move(sections_);
  }

 private:
  struct Place {
    std::uint64_t header = 0, table = 0, data = 0;
  };
  void place(const CgnsOutputNode& node) {
    Place at{.header = end_, .table = end_ + k_node_header};
    at.data = at.table + (node.children.empty() ? 0 : 20 + 44 * node.children.size());
    end_ = at.data + (node.has_data ? 20 + byte_size(node.array) : 0);
    places_.push_back(at);
    n_below_.push_back(0);
    const std::size_t own = places_.size() - 1;
    for (const CgnsOutputNode& child : node.children) place(child);
    n_below_[own] = places_.size() - own;
  }
  void put(const CgnsOutputNode& node, std::size_t& next) {
    const std::size_t own = next++;
    const Place& at = places_[own];
    const std::uint64_t n = node.children.size();
    text_ += "NoDe" + padded(node.name, k_name) + padded(node.label, k_name) + hex_text(n, 8) + hex_text(n, 8) + (n > 0 ? pointer_text(at.table) : k_no_pointer) +
             padded(node.has_data ? cgns_type_of(node.array.kind) : "MT", k_name);
    const std::size_t n_extents = node.has_data ? node.array.extents.size() : 0;
    text_ += hex_text(n_extents, 2);
    for (std::size_t k = 0; k < k_max_extents; ++k) text_ += hex_text(k < n_extents ? node.array.extents[k] : 0, 8);
    text_ += (node.has_data ? "0001" + pointer_text(at.data) : "0000" + k_no_pointer) + "TaiL";
    if (n > 0) {
      text_ += "SNTb" + pointer_text(at.table + 16 + 44 * n);
      std::size_t child = own + 1;
      for (const CgnsOutputNode& below : node.children) {
        text_ += padded(below.name, k_name) + pointer_text(places_[child].header);
        child += n_below_[child];
      }
      text_ += "snTE";
    }
    if (node.has_data) {
      text_ += "DaTa" + pointer_text(at.data + 16 + byte_size(node.array));
      flush();
      sections_.insert(sections_.end(), node.array.content.begin(), node.array.content.end());
      text_ = "dEnD";
    }
    for (const CgnsOutputNode& child : node.children) put(child, next);
  }
  void flush() {
    if (!text_.empty()) sections_.push_back(fixed_section(std::move(text_)));
    text_.clear();
  }

  std::uint64_t end_ = k_file_header + k_free_table;
  std::vector<Place> places_;
  std::vector<std::size_t> n_below_;  ///< nodes of the subtree, itself counted
  std::string text_;
  std::vector<OutputSection> sections_;
};

}  // namespace

bool is_adf(std::string_view bytes) { return bytes.substr(0, 32).find("ADF Database Version ") == 4; }

std::unique_ptr<CgnsContainer> open_cgns_adf(const FileBuffer& buffer) { return std::make_unique<AdfContainer>(buffer); }

std::vector<OutputSection> cgns_adf_sections(const CgnsOutputNode& root) {
  CgnsOutputNode file = root;
  file.name = "ADF MotherNode";
  file.label = "Root Node of ADF File";
  return AdfWriter().sections(file);
}

}  // namespace sterna::io
