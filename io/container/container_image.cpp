#include "io/container/container_image.h"

#include <algorithm>
#include <cstring>

#include "io/input/file_buffer.h"

namespace sterna::io {
namespace {

using wire::ImageHeader;
using wire::NodeRecord;
using wire::Role;

/// Returns true if `where` is a valid location from the helper: a path, a variable or an attribute (by name or number), or the whole file.
bool is_location(std::string_view where) {
  if (where.starts_with('/') || where == "the file" || where == "the head of the file") return true;
  for (const std::string_view begin : {"variable ", "attribute "})
    if (where.starts_with(begin) && where.size() > begin.size())
      return (where[begin.size()] >= '0' && where[begin.size()] <= '9') || (where[begin.size()] == '"' && where.size() > begin.size() + 2);
  return false;
}

/// Reads the image in memory and checks every access. An invalid image is a fault of the helper, not of the user, but only a damaged file can have caused it.
class ImageReader {
 public:
  ImageReader(std::span<const std::byte> bytes, const std::string& source) : bytes_(bytes), source_(source) {
    if (bytes_.size() < sizeof header_) fail("the image has " + std::to_string(bytes_.size()) + " bytes");
    std::memcpy(&header_, bytes_.data(), sizeof header_);
    if (header_.magic != wire::k_image_magic) fail("the image has another version: build the target sterna-read-container again");
    if (header_.n_nodes > (bytes_.size() - sizeof header_) / sizeof(NodeRecord))
      fail("the image has room for fewer nodes than " + std::to_string(header_.n_nodes));
    const std::uint64_t text_begin = sizeof header_ + sizeof(NodeRecord) * header_.n_nodes;
    if (header_.text_size > bytes_.size() - text_begin) fail("the text block exceeds the image");
    text_ = {reinterpret_cast<const char*>(bytes_.data()) + text_begin, header_.text_size};
    if (header_.outcome != wire::Outcome::ok) throw_outcome();
    if (header_.n_nodes == 0) fail("the image has no root");
  }

  ContainerNode read_root() {
    records_.resize(header_.n_nodes);
    std::memcpy(records_.data(), bytes_.data() + sizeof header_, sizeof(NodeRecord) * header_.n_nodes);
    children_.resize(header_.n_nodes);
    if (records_[0].parent != 0 || records_[0].role != Role::group) fail("the first node is not a root");
    for (std::uint32_t i = 1; i < header_.n_nodes; ++i) {
      const std::uint32_t parent = records_[i].parent;
      if (parent >= i) fail("node " + std::to_string(i) + " comes before its parent");
      if (records_[i].role > Role::left_out) fail("node " + std::to_string(i) + " has an unknown role");
      const Role above = records_[parent].role;
      if (above != Role::group && !(above == Role::dataset && records_[i].role == Role::attribute))
        fail("node " + std::to_string(i) + " is below a node that cannot have children");
      children_[parent].push_back(i);
    }
    return node(0, "", 0);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw_malformed(source_, "the file", "sterna-read-container returned invalid data: " + problem); }

  [[noreturn]] void throw_outcome() const {
    const std::string where(text(header_.where)), problem(text(header_.problem)), hint(text(header_.hint));
    if (!is_location(where) || problem.empty()) fail("the file was rejected without location or reason");
    if (header_.outcome == wire::Outcome::unsupported) throw_unsupported(source_, where + ": " + problem, hint);
    throw_malformed(source_, where, problem, hint);
  }

  std::string_view text(const wire::Text& location) const {
    if (location.begin > text_.size() || location.size > text_.size() - location.begin) fail("a string exceeds the text block");
    return text_.substr(location.begin, location.size);
  }

  ContainerValues values(const NodeRecord& record, std::string where) const {
    ContainerValues result{.trouble = record.trouble, .problem = std::string(text(record.problem))};
    NumberArray& array = result.array;
    array.source = source_;
    array.where = std::move(where);
    if (record.trouble > wire::Trouble::unsupported) fail("an error code is unknown");
    if (record.trouble != wire::Trouble::none) return result;
    if (static_cast<std::size_t>(record.kind) >= k_number_kinds) fail("a number type is unknown");
    if (record.rank > wire::k_max_rank) fail("an array has " + std::to_string(record.rank) + " extents");
    array.kind = record.kind;
    array.order = record.is_big_endian != 0 ? std::endian::big : std::endian::little;
    array.extents.assign(record.extents, record.extents + record.rank);
    std::uint64_t n_bytes = 0;
    if (__builtin_mul_overflow(count_of(array.extents, source_, array.where), byte_size(array.kind), &n_bytes) || n_bytes != record.n_bytes)
      fail("an array has " + std::to_string(record.n_bytes) + " bytes");
    if (record.begin > bytes_.size() || n_bytes > bytes_.size() - record.begin) fail("an array exceeds the image");
    array.bytes = {reinterpret_cast<const char*>(bytes_.data()) + record.begin, n_bytes};
    return result;
  }

  ContainerNode node(std::uint32_t number, std::string path, std::uint32_t depth) const {
    const NodeRecord& record = records_[number];
    if (depth > wire::k_max_depth + 1) fail("nodes are nested more than " + std::to_string(wire::k_max_depth) + " deep");
    ContainerNode result{.name = std::string(text(record.name)), .path = path.empty() ? "/" : path, .role = record.role};
    if (record.role == Role::dataset) result.values = values(record, result.path);
    for (const std::uint32_t below : children_[number]) {
      const NodeRecord& child = records_[below];
      std::string name(text(child.name));
      if (child.role == Role::attribute) {
        ContainerValues found = values(child, result.path + ", attribute \"" + name + "\"");
        result.attributes.insert_or_assign(std::move(name), std::move(found));
      } else {
        result.children.push_back(node(below, path + "/" + name, depth + 1));
      }
    }
    return result;
  }

  std::span<const std::byte> bytes_;
  const std::string& source_;
  ImageHeader header_;
  std::string_view text_;
  std::vector<NodeRecord> records_;
  std::vector<std::vector<std::uint32_t>> children_;
};

}  // namespace

const ContainerNode* ContainerNode::find(std::string_view expected) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const ContainerNode& child) { return child.name == expected; });
  return found == children.end() ? nullptr : &*found;
}

const NumberArray* ContainerNode::attribute(const std::string& expected) const {
  const auto found = attributes.find(expected);
  return found == attributes.end() || found->second.trouble != wire::Trouble::none ? nullptr : &found->second.array;
}

ContainerImage::ContainerImage(std::shared_ptr<const void> owner, std::span<const std::byte> bytes, std::string source)
    : owner_(std::move(owner)), source_(std::move(source)), root_(ImageReader(bytes, source_).read_root()) {}

const ContainerNode& ContainerImage::child(const ContainerNode& parent, std::string_view name) const {
  const ContainerNode* const found = parent.find(name);
  if (!found) throw_malformed(source_, (parent.path == "/" ? "" : parent.path) + "/" + std::string(name), "there is no such group or dataset in the file");
  if (found->role == Role::link)
    throw_unsupported(source_, found->path + " is a link by name, perhaps to another file", "copy the data into one file: h5copy, h5repack");
  return *found;
}

NumberArray ContainerImage::data(const ContainerNode& dataset) const {
  if (dataset.role == Role::link)
    throw_unsupported(source_, dataset.path + " is a link by name, perhaps to another file", "copy the data into one file: h5copy, h5repack");
  if (dataset.role != Role::dataset) throw_malformed(source_, dataset.path, "this is not a dataset");
  if (dataset.values.trouble == wire::Trouble::malformed) throw_malformed(source_, dataset.path, dataset.values.problem);
  if (dataset.values.trouble == wire::Trouble::unsupported) throw_unsupported(source_, dataset.path + ": " + dataset.values.problem);
  return dataset.values.array;
}

}  // namespace sterna::io
