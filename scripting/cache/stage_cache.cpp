// An entry is a sealed file (sealed_file.h) <first two digits>/<key>.stage: the stage's name, then the output of its writer.
// An entry is written under a temporary name and renamed. It is therefore complete once it has its name, and a killed process leaves nothing that another
// process reads. Readers hold a shared lock; an entry is evicted only if it has no locks, and a file that is removed during reading stays readable.
#include "scripting/cache/stage_cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <tuple>

#include "geom/base/error.h"
#include "scripting/cache/build_identity.h"
#include "scripting/cache/content_key.h"
#include "scripting/cache/sealed_file.h"

namespace sterna::scripting {
namespace {

constexpr const char* k_extension = ".stage";
using Seal = std::array<std::uint8_t, 16>;

void remove_damaged(const std::filesystem::path& path, std::string_view stage, const std::string& problem, const RunContext& context) {
  context.warn("cache: the entry " + path.string() + " of " + std::string(stage) + " is damaged (" + problem + "): the entry is removed and computed again");
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) context.warn("cache: " + path.string() + " could not be removed: " + error.message());
}

bool is_key_text(const std::string& text) { return text.size() == 2 * sizeof(Seal) && text.find_first_not_of("0123456789abcdef") == std::string::npos; }

/// A file of the cache as listed by the file system.
struct Listed {
  std::filesystem::file_time_type used;
  std::filesystem::path file;
  std::uint64_t bytes = 0;
};

/// Other processes add and remove files meanwhile: files that have disappeared are skipped.
std::vector<Listed> listed(const std::filesystem::path& folder) {
  std::vector<Listed> result;
  std::error_code gone;
  for (std::filesystem::directory_iterator parts(folder, gone), end; !gone && parts != end; parts.increment(gone)) {
    if (parts->path().filename().string().size() != 2) continue;
    std::error_code none;
    for (std::filesystem::directory_iterator files(parts->path(), none), last; !none && files != last; files.increment(none)) {
      const std::filesystem::path& file = files->path();
      if (file.extension() != k_extension || !is_key_text(file.stem().string())) continue;
      std::error_code no_time, no_size;
      Listed entry{files->last_write_time(no_time), file, files->file_size(no_size)};
      if (!no_time && !no_size) result.push_back(std::move(entry));
    }
  }
  return result;
}

void require_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    throw Error({.code = ErrorCode::file_not_found, .attempted = "opening the cache " + folder.string(), .problem = "there is no such folder"});
}

}  // namespace

StageCache::StageCache(CacheSettings settings) : settings_(std::move(settings)) {
  if (settings_.identity.empty()) settings_.identity = build_identity();
  std::error_code error;
  std::filesystem::create_directories(settings_.folder, error);
  if (!std::filesystem::is_directory(settings_.folder))
    throw Error({.code = ErrorCode::write_failed,
                 .attempted = "creating the cache " + settings_.folder.string(),
                 .problem = error ? error.message() : "there is a file with this name",
                 .hint = "name a folder"});
}

std::filesystem::path StageCache::path_of(std::string_view stage, const ContentKey& key) const {
  const std::string name = KeyMaker("entry").add(settings_.identity).add(k_sealed_schema).add(stage).add(key).key().hex();
  return settings_.folder / name.substr(0, 2) / (name + k_extension);
}

bool StageCache::find(std::string_view stage, const ContentKey& key, const std::function<void(ByteSource&)>& read, const RunContext& context) const {
  const std::filesystem::path path = path_of(stage, key);
  SealedFile file(path);
  if (!file.is_open()) {
    if (errno != ENOENT) context.warn("cache: " + path.string() + " cannot be opened: " + std::generic_category().message(errno));
    return false;
  }
  ::flock(file.descriptor(), LOCK_SH | LOCK_NB);  // the lock is held until the file is closed; without it the file could only be evicted too early
  if (const std::string problem = file.problem(key, context); !problem.empty()) {
    remove_damaged(path, stage, problem, context);
    return false;
  }
  try {
    const std::unique_ptr<ByteSource> source = file.content();
    std::string name;
    read_value(*source, name);
    if (name != stage) source->refuse();
    read(*source);
    if (source->n_left() > 0) source->refuse();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::file_malformed) throw;
    remove_damaged(path, stage, error.info().problem, context);
    return false;
  }
  // Sets the time of last use. If the time cannot be written, the entry is only evicted earlier than others.
  ::futimens(file.descriptor(), nullptr);
  return true;
}

void StageCache::store(std::string_view stage, const ContentKey& key, const std::function<void(ByteSink&)>& write, const RunContext& context) const {
  const std::filesystem::path path = path_of(stage, key);
  try {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);  // AtomicFile reports the reason of a failure
    const auto write_entry = [&](ByteSink& sink) {
      write_value(sink, std::string(stage));
      write(sink);
    };
    write_sealed(path, key, write_entry, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::write_failed) throw;
    context.warn("cache: the result of " + std::string(stage) + " is not stored: " + error.what());
    return;
  }
  trim(path, context);
}

void StageCache::trim(const std::filesystem::path& newest, const RunContext& context) const {
  std::vector<Listed> files = listed(settings_.folder);
  double bytes = 0.0;
  for (const Listed& file : files) bytes += static_cast<double>(file.bytes);
  if (bytes <= settings_.limit) return;
  std::sort(files.begin(), files.end(), [](const Listed& a, const Listed& b) { return std::tie(a.used, a.file) < std::tie(b.used, b.file); });
  std::size_t n_removed = 0;
  for (const Listed& old : files) {
    if (bytes <= settings_.limit) break;
    if (old.file == newest) continue;
    const SealedFile file(old.file);
    if (!file.is_open() || ::flock(file.descriptor(), LOCK_EX | LOCK_NB) != 0) continue;  // removed, or in use by a reader
    std::error_code error;
    if (!std::filesystem::remove(old.file, error) && error) {
      context.warn("cache: " + old.file.string() + " could not be removed: " + error.message());
      continue;
    }
    bytes -= static_cast<double>(old.bytes);
    ++n_removed;
  }
  context.info("cache: size limit exceeded, " + std::to_string(n_removed) + " least recently used entries were removed");
}

std::vector<CacheEntry> StageCache::entries(const std::filesystem::path& folder) {
  require_folder(folder);
  std::vector<CacheEntry> result;
  for (const Listed& file : listed(folder)) {
    CacheEntry entry{file.file, {}, file.bytes};
    SealedFile open(file.file);
    if (open.has_head()) {
      try {
        read_value(*open.content(), entry.stage);
      } catch (const Error&) {
        entry.stage.clear();  // as the interface states, an empty name means a damaged file
      }
    }
    result.push_back(std::move(entry));
  }
  std::sort(result.begin(), result.end(), [](const CacheEntry& a, const CacheEntry& b) { return a.file < b.file; });
  return result;
}

std::size_t StageCache::clear(const std::filesystem::path& folder) {
  require_folder(folder);
  std::size_t n_removed = 0;
  for (const Listed& file : listed(folder)) {
    std::error_code error;
    n_removed += std::filesystem::remove(file.file, error) ? 1 : 0;
    if (error) throw Error({.code = ErrorCode::write_failed, .attempted = "removing " + file.file.string(), .problem = error.message()});
  }
  return n_removed;
}

void report_reuse(const Reuse& reuse, std::string_view stage, std::string_view what, const RunContext& context) {
  const std::string line = std::string(stage) + (what.empty() ? "" : " " + std::string(what));
  context.info(line + ": from the cache");
  if (reuse.lines != nullptr) reuse.lines->push_back(line);
}

}  // namespace sterna::scripting
