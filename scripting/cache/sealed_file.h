// Values in a file of their own, sealed by their hash: what the cache keeps, and what the reference case of a series keeps for the others.
//   head     16 bytes magic, u32 version of this layout, u32 0x01020304, 16 bytes key, u64 bytes of content
//   content  what the writer wrote (archive.h)
//   seal     16 bytes XXH3-128 of content and head
// A file appears whole or not at all (io::AtomicFile), and nothing is taken from it before its hash is proved.
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

/// Raised when what is kept changes its meaning without its structs or keys.
inline constexpr std::uint32_t k_sealed_schema = 1;

/// \throws Error(write_failed, cancelled)
void write_sealed(const std::filesystem::path& path, const ContentKey& key, const std::function<void(ByteSink&)>& write, const RunContext& context);

/// An open file, or one that is not there.
class SealedFile {
 public:
  explicit SealedFile(const std::filesystem::path& path);
  ~SealedFile();
  SealedFile(const SealedFile&) = delete;
  SealedFile& operator=(const SealedFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }  ///< errno says why not, right after construction
  int descriptor() const { return descriptor_; }

  /// What is wrong with the file as one of that key; empty when nothing is. Reads all of it.
  /// \throws Error(cancelled)
  std::string problem(const ContentKey& key, const RunContext& context);
  /// Whether it begins as such a file does, of whatever key; its content is not proved.
  bool has_head();
  /// Hash of content and head.
  /// \pre problem() was empty
  const ContentKey& seal() const { return seal_; }
  /// The content, from its start; must not outlive this.
  /// \pre problem() was empty, or has_head()
  std::unique_ptr<ByteSource> content() const;

 private:
  int descriptor_ = -1;
  std::uint64_t n_bytes_ = 0;  ///< of content, as the head says
  ContentKey seal_;
};

}  // namespace sterna::scripting
