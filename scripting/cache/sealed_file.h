// Values in a separate file, sealed by their hash. Such files hold entries of the cache, and the data that the reference case of a series stores for the other
// cases.
//   head     16 bytes magic, u32 version of this layout, u32 0x01020304, 16 bytes key, u64 bytes of content
//   content  bytes of the writer (archive.h)
//   seal     16 bytes XXH3-128 of content and head
// A file is written atomically (io::AtomicFile), and no content is read before its hash is verified.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "geom/base/run_context.h"
#include "scripting/cache/archive.h"
#include "scripting/cache/provenance.h"

namespace sterna::scripting {

/// Version of the stored data. Increment it if they change their meaning without a change of their structs or keys.
inline constexpr std::uint32_t k_sealed_schema = 1;

/// \throws Error(write_failed, cancelled)
void write_sealed(const std::filesystem::path& path, const ContentKey& key, const std::function<void(ByteSink&)>& write, const RunContext& context);

/// An open or missing file.
class SealedFile {
 public:
  explicit SealedFile(const std::filesystem::path& path);
  ~SealedFile();
  SealedFile(const SealedFile&) = delete;
  SealedFile& operator=(const SealedFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }  ///< errno gives the reason of a failure, right after construction
  int descriptor() const { return descriptor_; }

  /// Returns the defect of the file as a sealed file of that key; empty if there is none. Reads the whole file.
  /// \throws Error(cancelled)
  std::string problem(const ContentKey& key, const RunContext& context);
  /// Returns true if the file begins as such a file, for any key; its content is not verified.
  bool has_head();
  /// Returns the hash of content and head.
  /// \pre problem() was empty
  const ContentKey& seal() const { return seal_; }
  /// Returns the content, from its start; must not outlive this.
  /// \pre problem() was empty, or has_head()
  std::unique_ptr<ByteSource> content() const;

 private:
  int descriptor_ = -1;
  std::uint64_t n_bytes_ = 0;  ///< size of the content, as given in the head
  ContentKey seal_;
};

}  // namespace sterna::scripting
