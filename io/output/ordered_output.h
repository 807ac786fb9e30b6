// Bytes made by all threads, written in order: chunks are filled in parallel, a batch at a time, while the batch before goes to the disk.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

#include "geom/base/run_context.h"
#include "io/output/atomic_file.h"

namespace sterna::io {

/// Growing bytes that are never cleared (std::string would fill them first).
class ByteBuffer {
 public:
  /// Room for `n` more bytes; write there and say with end_at() how far.
  char* reserve(std::size_t n) {
    if (size_ + n > capacity_) grow(size_ + n);
    return bytes_.get() + size_;
  }
  void end_at(const char* end) { size_ = static_cast<std::size_t>(end - bytes_.get()); }
  void append(std::string_view text) {
    end_at(text.data() ? std::char_traits<char>::copy(reserve(text.size()), text.data(), text.size()) + text.size() : reserve(0));
  }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  std::string_view view() const { return {bytes_.get(), size_}; }

 private:
  void grow(std::size_t n);
  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Fills one chunk's bytes into an empty buffer; called from any thread.
using FillChunk = std::function<void(std::size_t chunk, ByteBuffer& out)>;

/// Takes the bytes of the chunks in order, one call at a time; called from any thread.
using TakeBytes = std::function<void(std::string_view bytes)>;

/// Hands over the bytes of chunks 0 .. n_chunks-1, in order; the same for any number of threads. At most 2 * k_batch_chunks buffers live at a time. Reports
/// progress in [0, 1] of `context`.
/// \throws what `fill` and `take` throw; Error(cancelled).
void write_ordered(const TakeBytes& take, std::size_t n_chunks, const FillChunk& fill, const RunContext& context);

/// The same to the end of `file`.
/// \throws what AtomicFile::append throws, too
void write_ordered(AtomicFile& file, std::size_t n_chunks, const FillChunk& fill, const RunContext& context);

/// Chunks per batch: enough for 16 threads, and with buffers of 0.3 - 1.6 MB below 100 MB in all.
inline constexpr std::size_t k_batch_chunks = 32;

}  // namespace sterna::io
