#include "io/output/ordered_output.h"

#include <algorithm>
#include <vector>

#include "geom/base/parallel.h"

namespace sterna::io {

void ByteBuffer::grow(std::size_t n) {
  const std::size_t capacity = std::max(n, capacity_ + capacity_ / 2);
  auto bytes = std::make_unique_for_overwrite<char[]>(capacity);
  std::copy_n(bytes_.get(), size_, bytes.get());
  bytes_ = std::move(bytes);
  capacity_ = capacity;
}

void write_ordered(AtomicFile& file, std::size_t n_chunks, const FillChunk& fill, const RunContext& context) {
  write_ordered([&](std::string_view bytes) { file.append(bytes); }, n_chunks, fill, context);
}

void write_ordered(const TakeBytes& take, std::size_t n_chunks, const FillChunk& fill, const RunContext& context) {
  std::vector<ByteBuffer> filling(std::min(n_chunks, k_batch_chunks));
  std::vector<ByteBuffer> writing(filling.size());
  std::size_t n_writing = 0;
  const auto write_batch = [&] {
    for (std::size_t i = 0; i < n_writing; ++i) take(writing[i].view());
  };
  for (std::size_t first = 0; first < n_chunks; first += k_batch_chunks) {
    const std::size_t n_filling = std::min(k_batch_chunks, n_chunks - first);
    parallel_invoke(context, write_batch, [&] {
      parallel_chunks(context, n_filling, 1, [&](std::size_t i, std::size_t) {
        filling[i].clear();
        fill(first + i, filling[i]);
      });
    });
    filling.swap(writing);
    n_writing = n_filling;
    context.progress(static_cast<double>(first + n_filling) / static_cast<double>(n_chunks));
  }
  write_batch();
}

}  // namespace sterna::io
