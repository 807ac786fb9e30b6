// Generates bytes in parallel and writes them in order. Chunks are filled in parallel, one batch at a time, while the previous batch is written to the disk.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

#include "geom/base/run_context.h"
#include "io/output/atomic_file.h"

namespace sterna::io {

/// Growing byte buffer that is never initialised (std::string would clear its bytes first).
class ByteBuffer {
 public:
  /// Reserves room for `n` more bytes; write there, then set the end with end_at().
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

/// Fills the bytes of one chunk into an empty buffer; called from any thread.
using FillChunk = std::function<void(std::size_t chunk, ByteBuffer& out)>;

/// Receives the bytes of the chunks in order, one call at a time; called from any thread.
using TakeBytes = std::function<void(std::string_view bytes)>;

/// Passes the bytes of chunks 0 .. n_chunks-1 to `take`, in order; the result does not depend on the number of threads. At most 2 * k_batch_chunks buffers
/// exist at a time. Reports progress in [0, 1] of `context`.
/// \throws errors of `fill` and `take`; Error(cancelled).
void write_ordered(const TakeBytes& take, std::size_t n_chunks, const FillChunk& fill, const RunContext& context);

/// Appends the bytes of the chunks to `file`.
/// \throws as the overload above; errors of AtomicFile::append
void write_ordered(AtomicFile& file, std::size_t n_chunks, const FillChunk& fill, const RunContext& context);

/// Number of chunks per batch. It is enough for 16 threads, and buffers of 0.3 - 1.6 MB take less than 100 MB in total.
inline constexpr std::size_t k_batch_chunks = 32;

}  // namespace sterna::io
