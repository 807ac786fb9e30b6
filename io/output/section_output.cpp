#include "io/output/section_output.h"

#include <charconv>

#include "geom/base/error.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_items_per_chunk = 4096;  // about 250 kB of text

struct Chunk {
  const OutputSection* section;
  std::uint64_t begin, end;
};

}  // namespace

OutputSection fixed_section(std::string bytes) {
  return {.n_items = 1, .format = [bytes = std::move(bytes)](std::uint64_t, std::uint64_t, ByteBuffer& out) { out.append(bytes); }};
}

void write_sections(const TakeBytes& take, const std::vector<OutputSection>& sections, std::uint64_t items_per_chunk, const RunContext& context) {
  std::vector<Chunk> chunks;
  for (const OutputSection& section : sections)
    for (std::uint64_t begin = 0; begin < section.n_items; begin += items_per_chunk)
      chunks.push_back({&section, begin, std::min(begin + items_per_chunk, section.n_items)});
  write_ordered(
      take, chunks.size(), [&](std::size_t i, ByteBuffer& out) { chunks[i].section->format(chunks[i].begin, chunks[i].end, out); }, context);
}

void write_sections(AtomicFile& file, const std::vector<OutputSection>& sections, const RunContext& context) {
  write_sections([&](std::string_view bytes) { file.append(bytes); }, sections, k_items_per_chunk, context);
}

char* put_real_text(char* at, double value) { return std::to_chars(at, at + k_max_real_text, value).ptr; }
char* put_integer_text(char* at, std::int64_t value) { return std::to_chars(at, at + k_max_integer_text, value).ptr; }

void require_count(std::uint64_t n, std::uint64_t limit, const std::string& what, const std::string& format, const std::string& path) {
  if (n <= limit) return;
  throw Error({.code = ErrorCode::overflow,
               .attempted = "writing " + path,
               .problem = std::to_string(n) + " " + what + ", but " + format + " cannot count beyond " + std::to_string(limit),
               .hint = "use a coarser mesh or a format with 64-bit counts"});
}

void throw_node_not_finite(std::uint64_t node) {
  throw Error({.code = ErrorCode::mesh_invalid,
               .attempted = "writing a volume mesh",
               .problem = "the coordinates of node " + std::to_string(node) + " are not finite"});
}

}  // namespace sterna::io
