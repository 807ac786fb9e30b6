// Stores results of stages on disk by the content of their inputs. Several processes may use a cache at once, on one machine or on shared disks. No entry is
// trusted before verification.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/cache/archive.h"
#include "scripting/cache/provenance.h"
#include "scripting/cache/reuse.h"

namespace sterna::scripting {

inline constexpr double k_cache_limit = 20e9;

struct CacheSettings {
  std::filesystem::path folder;  ///< created if missing
  double limit = k_cache_limit;  ///< bytes; when exceeded, the least recently used entries are evicted
  std::string identity;          ///< identity of the calling program; empty: build_identity()
};

/// One file of a cache, as listed by entries().
struct CacheEntry {
  std::filesystem::path file;
  std::string stage;  ///< stage of the result; empty if the head is damaged
  std::uint64_t bytes = 0;
};

class StageCache {
 public:
  /// \throws Error(write_failed) if the folder cannot be created
  explicit StageCache(CacheSettings settings);

  const std::filesystem::path& folder() const { return settings_.folder; }

  /// Passes the entry of this stage and key to `read`, after its hash is verified. Returns false if there is no entry. A damaged entry is removed, with a
  /// warning.
  /// \throws Error(cancelled)
  bool find(std::string_view stage, const ContentKey& key, const std::function<void(ByteSource&)>& read, const RunContext& context) const;
  /// Stores the output of `write`. The entry is written atomically. A full or write-protected disk only gives a warning: the run continues. Then the least
  /// recently used entries are evicted until the limit holds, but never the new entry, nor one that is being read.
  /// \throws Error(cancelled)
  void store(std::string_view stage, const ContentKey& key, const std::function<void(ByteSink&)>& write, const RunContext& context) const;

  /// Returns the entries of a folder, in order of file names; entries of all builds.
  /// \throws Error(file_not_found) if there is no such folder
  static std::vector<CacheEntry> entries(const std::filesystem::path& folder);
  /// Removes all entries; returns their number.
  /// \throws Error(file_not_found, write_failed)
  static std::size_t clear(const std::filesystem::path& folder);

 private:
  std::filesystem::path path_of(std::string_view stage, const ContentKey& key) const;
  void trim(const std::filesystem::path& newest, const RunContext& context) const;

  CacheSettings settings_;
};

/// Logs that a stage came from the cache.
void report_reuse(const Reuse& reuse, std::string_view stage, std::string_view what, const RunContext& context);

/// Returns the result of a stage: from the cache, or computed and stored. Nothing is stored without a key, nor if `may_keep` returns false for the result.
/// \param what for the log: "of body, wing"; may be empty
template <class T>
T cached(const Reuse& reuse, std::string_view stage, std::string_view what, const std::optional<ContentKey>& key, const RunContext& context,
         const std::function<T()>& make, const std::function<void(ByteSink&, const T&)>& write, const std::function<T(ByteSource&)>& read,
         const std::function<bool(const T&)>& may_keep = {}) {
  if (reuse.cache == nullptr) return make();
  if (!key) {
    context.debug(std::string(stage) + ": cannot be cached, because the origin of some input is unknown");
    return make();
  }
  std::optional<T> found;
  if (reuse.cache->find(
          stage, *key, [&](ByteSource& source) { found.emplace(read(source)); }, context)) {
    report_reuse(reuse, stage, what, context);
    return std::move(*found);
  }
  T value = make();
  if (!may_keep || may_keep(value))
    reuse.cache->store(
        stage, *key, [&](ByteSink& sink) { write(sink, value); }, context);
  return value;
}

/// The same for types supported by archive.h.
template <class T>
T cached(const Reuse& reuse, std::string_view stage, std::string_view what, const std::optional<ContentKey>& key, const RunContext& context,
         const std::function<T()>& make, const std::function<bool(const T&)>& may_keep = {}) {
  const auto read = [](ByteSource& source) {
    T value;
    read_value(source, value);
    return value;
  };
  return cached<T>(reuse, stage, what, key, context, make, write_value<T>, read, may_keep);
}

}  // namespace sterna::scripting
