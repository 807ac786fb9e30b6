#include "io/output/output_array.h"

namespace sterna::io {

OutputArray output_text(std::string text, NumberKind kind) { return {.kind = kind, .extents = {text.size()}, .content = {fixed_section(std::move(text))}}; }

std::uint64_t count_of(const OutputArray& array) {
  std::uint64_t n = 1;
  for (const std::uint64_t extent : array.extents) n *= extent;
  return n;
}

void stream_arrays(const std::vector<const OutputArray*>& arrays, const PutValues& put, const RunContext& context) {
  std::vector<OutputSection> sections;
  for (const OutputArray* array : arrays) sections.insert(sections.end(), array->content.begin(), array->content.end());
  std::size_t array = 0;
  std::uint64_t n_done = 0;  // number of values of the array that are done
  const auto append = [&](std::string_view bytes) {
    if (bytes.empty()) return;
    while (n_done == count_of(*arrays[array])) {
      ++array;
      n_done = 0;
    }
    put(array, n_done, bytes);
    n_done += bytes.size() / byte_size(arrays[array]->kind);
  };
  write_sections(append, sections, k_items_per_chunk_of_numbers, context);
}

std::unique_lock<std::mutex> hold_container_libraries() {
  static std::mutex libraries;  // guards the global state of the libraries
  return std::unique_lock(libraries);
}

}  // namespace sterna::io
