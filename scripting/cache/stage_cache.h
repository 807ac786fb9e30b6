// Results of stages on disk, by the content of what they were made of. For several processes at once, on one machine or on shared disks; nothing in it is
// trusted.
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
  std::filesystem::path folder;  ///< made where it is not there
  double limit = k_cache_limit;  ///< bytes: above it the entries go that were not used for longest
  std::string identity;          ///< of the program that asks; empty: build_identity()
};

/// One file of a cache.
struct CacheEntry {
  std::filesystem::path file;
  std::string stage;  ///< what it is a result of; empty where its head is damaged
  std::uint64_t bytes = 0;
};

class StageCache {
 public:
  /// \throws Error(write_failed) when the folder cannot be made
  explicit StageCache(CacheSettings settings);

  const std::filesystem::path& folder() const { return settings_.folder; }

  /// Hands the entry of this stage and key to `read`, once its hash has proved that it is as it was stored. False: there is none. One that is damaged is
  /// removed, with a warning.
  /// \throws Error(cancelled)
  bool find(std::string_view stage, const ContentKey& key, const std::function<void(ByteSource&)>& read, const RunContext& context) const;
  /// Keeps what `write` writes. The entry appears whole or not at all. A disk that is full or may not be written to is a warning: the run goes on. Then the
  /// entries that were not used for longest go, until the limit holds; never this one, nor one that is being read.
  /// \throws Error(cancelled)
  void store(std::string_view stage, const ContentKey& key, const std::function<void(ByteSink&)>& write, const RunContext& context) const;

  /// Of a folder, in order of file names; entries of all builds.
  /// \throws Error(file_not_found) when there is no such folder
  static std::vector<CacheEntry> entries(const std::filesystem::path& folder);
  /// Removes all entries; returns how many.
  /// \throws Error(file_not_found, write_failed)
  static std::size_t clear(const std::filesystem::path& folder);

 private:
  std::filesystem::path path_of(std::string_view stage, const ContentKey& key) const;
  void trim(const std::filesystem::path& newest, const RunContext& context) const;

  CacheSettings settings_;
};

/// What a log says of a stage that came from the cache.
void report_reuse(const Reuse& reuse, std::string_view stage, std::string_view what, const RunContext& context);

/// The result of a stage: from the cache, or made and kept. Nothing is kept without a key, nor where `may_keep` says no of the result.
/// \param what for the log: "of body, wing"; may be empty
template <class T>
T cached(const Reuse& reuse, std::string_view stage, std::string_view what, const std::optional<ContentKey>& key, const RunContext& context,
         const std::function<T()>& make, const std::function<void(ByteSink&, const T&)>& write, const std::function<T(ByteSource&)>& read,
         const std::function<bool(const T&)>& may_keep = {}) {
  if (reuse.cache == nullptr) return make();
  if (!key) {
    context.debug(std::string(stage) + ": cannot be cached, as it is not known what all of its input was made of");
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

/// The same of what archive.h knows.
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
