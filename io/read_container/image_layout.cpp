#include "io/read_container/image_layout.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace sterna::io::reader {
namespace {

using wire::ImageHeader;
using wire::NodeRecord;

/// Minimum number of bytes of a node in any container: a NetCDF attribute.
constexpr std::uint64_t k_smallest_node = 12;

constexpr std::uint64_t aligned(std::uint64_t n) { return (n + wire::k_alignment - 1) / wire::k_alignment * wire::k_alignment; }

/// Collects the text section of an image.
class TextPool {
 public:
  wire::Text add(std::string_view text) {
    const wire::Text location{.begin = text_.size(), .size = text.size()};
    text_ += text;
    return location;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Maps the memfd at its full size.
char* map_image(std::uint64_t size) {
  if (ftruncate(wire::k_image_fd, static_cast<off_t>(size)) != 0) throw std::bad_alloc();
  void* const block = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, wire::k_image_fd, 0);
  if (block == MAP_FAILED) throw std::bad_alloc();
  return static_cast<char*>(block);
}

void put(char*& at, const void* data, std::size_t n) {
  if (n > 0) std::memcpy(at, data, n);
  at += n;
}

}  // namespace

std::uint64_t Node::n_bytes() const {
  if (trouble != wire::Trouble::none || !has_values()) return 0;
  std::uint64_t n = byte_size(kind);
  for (const std::uint64_t extent : extents) n *= extent;  // check_size() has checked the range
  return n;
}

std::uint64_t check_size(Node& node, std::uint64_t limit) {
  std::uint64_t n = byte_size(node.kind);
  if (node.extents.size() > wire::k_max_rank) {
    node.give_up(wire::Trouble::unsupported,
                 "it has " + std::to_string(node.extents.size()) + " extents, at most " + std::to_string(wire::k_max_rank) + " are read");
    return 0;
  }
  for (const std::uint64_t extent : node.extents) {
    if (!__builtin_mul_overflow(n, extent, &n)) continue;
    node.give_up(wire::Trouble::malformed, "the number of bytes does not fit 64 bits");
    return 0;
  }
  if (n > limit) {
    node.give_up(wire::Trouble::malformed, "its " + std::to_string(n) + " bytes are more than the " + std::to_string(limit) +
                                               " that the file can hold: the file may have been cut short");
    return 0;
  }
  return n;
}

std::uint32_t Image::add(Node node) {
  if (nodes_.size() > limits_.file_size / k_smallest_node + 1)
    throw Failure{.outcome = wire::Outcome::malformed,
                  .where = "the file",
                  .problem = "it refers to more groups and attributes than fit in a file of this size",
                  .hint = {}};
  nodes_.push_back(std::move(node));
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void Image::write() {
  TextPool text;
  std::vector<NodeRecord> records(nodes_.size());
  std::uint64_t n_values = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    NodeRecord& record = records[i];
    record = {.parent = node.parent,
              .role = node.role,
              .trouble = node.trouble,
              .kind = node.kind,
              .is_big_endian = node.is_big_endian,
              .name = text.add(node.name),
              .problem = text.add(node.problem)};
    if (!node.has_values() || node.trouble != wire::Trouble::none) continue;
    record.rank = static_cast<std::uint32_t>(node.extents.size());
    std::copy(node.extents.begin(), node.extents.end(), record.extents);
    record.n_bytes = node.n_bytes();
    record.begin = n_values;  // the beginning is corrected when the length of the text is known
    if (record.n_bytes > limits_.unpacked() || (n_values += aligned(record.n_bytes)) > limits_.unpacked())
      throw Failure{.outcome = wire::Outcome::malformed,
                    .where = "the file",
                    .problem = "its arrays unpack to more than " + std::to_string(limits_.unpacked()) + " bytes, too much for a mesh file of " +
                               std::to_string(limits_.file_size) + " bytes",
                    .hint = {}};
  }
  ImageHeader header{.n_nodes = static_cast<std::uint32_t>(nodes_.size()), .text_size = text.text().size()};
  const std::uint64_t first_value = aligned(sizeof header + sizeof(NodeRecord) * records.size() + text.text().size()), size = first_value + n_values;
  for (NodeRecord& record : records) record.begin += first_value;
  limit_memory(k_library_memory + 4 * limits_.file_size + 2 * size);  // chunks are unpacked in addition to the image
  char* const begin = map_image(size);
  char* at = begin;
  put(at, &header, sizeof header);
  put(at, records.data(), sizeof(NodeRecord) * records.size());
  put(at, text.text().data(), text.text().size());
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (records[i].n_bytes > 0 && nodes_[i].fill) nodes_[i].fill(begin + records[i].begin);
}

void write_failure(const Failure& failure) {
  TextPool text;
  ImageHeader header{.outcome = failure.outcome, .where = text.add(failure.where), .problem = text.add(failure.problem), .hint = text.add(failure.hint)};
  header.text_size = text.text().size();
  char* at = map_image(sizeof header + text.text().size());
  put(at, &header, sizeof header);
  put(at, text.text().data(), text.text().size());
}

void limit_memory(std::uint64_t n_bytes) {
  rlimit memory{};
  getrlimit(RLIMIT_AS, &memory);
  memory.rlim_cur = std::min<rlim_t>(n_bytes, memory.rlim_max);
  setrlimit(RLIMIT_AS, &memory);
}

}  // namespace sterna::io::reader
