// An entry is a file <first two digits>/<key>.stage:
//   head     16 bytes magic, u32 version of this layout, u32 0x01020304, 16 bytes key, u64 bytes of content
//   content  the stage's name, then what its writer wrote (archive.h)
//   seal     16 bytes XXH3-128 of content and head
// It is written under a temporary name and renamed, so it is whole whenever it has its name, and a killed process leaves nothing that anybody reads. Readers hold a shared
// lock; what is to go must be free of locks, and a file that is removed while it is read stays readable.
#include "scripting/cache/stage_cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <tuple>

#include "geom/base/error.h"
#include "io/atomic_file.h"
#include "scripting/cache/build_identity.h"
#include "scripting/cache/content_key.h"

namespace sterna::scripting {
namespace {

/// Raised when what is kept for a stage changes its meaning without its structs or keys.
constexpr std::uint32_t k_schema = 1;
constexpr std::uint32_t k_byte_order = 0x01020304;
constexpr std::array<char, 16> k_magic = {'\x89', 's', 't', 'a', 'g', 'e', '\r', '\n', '\x1a', '\n', 0, 0, 0, 0, 0, 0};
constexpr std::size_t k_piece = 1 << 20;  ///< bytes per system call
constexpr const char* k_extension = ".stage";

struct Head {
  std::array<char, 16> magic = k_magic;
  std::uint32_t schema = k_schema;
  std::uint32_t byte_order = k_byte_order;
  std::array<std::uint8_t, 16> key{};
  std::uint64_t n_bytes = 0;
};
static_assert(sizeof(Head) == 48);
using Seal = std::array<std::uint8_t, 16>;

std::span<const std::byte> bytes_of(const void* at, std::size_t n) { return {static_cast<const std::byte*>(at), n}; }

/// An open file.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path) : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  bool is_open() const { return number_ >= 0; }
  int number() const { return number_; }
  /// False where the file ends before.
  bool read(void* to, std::size_t n, std::uint64_t from) const {
    auto* at = static_cast<char*>(to);
    while (n > 0) {
      const ssize_t got = ::pread(number_, at, n, static_cast<off_t>(from));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      at += got;
      from += static_cast<std::uint64_t>(got);
      n -= static_cast<std::size_t>(got);
    }
    return true;
  }

 private:
  int number_;
};

class FileSink final : public ByteSink {
 public:
  FileSink(const std::filesystem::path& path, const ContentKey& key, const RunContext& context) : file_(path), context_(context) {
    head_.key = key.bytes;
    file_.append({reinterpret_cast<const char*>(&head_), sizeof head_});
    buffer_.reserve(k_piece);
  }
  void put(const void* bytes, std::size_t n) override {
    head_.n_bytes += n;
    if (buffer_.size() + n > k_piece) send();
    if (n > k_piece) {
      for (std::size_t i = 0; i < n; i += k_piece) send_piece(static_cast<const char*>(bytes) + i, std::min(k_piece, n - i));
      return;
    }
    buffer_.append(static_cast<const char*>(bytes), n);
  }
  void commit() {
    send();
    hash_.append(bytes_of(&head_, sizeof head_));
    const Seal seal = hash_.digest();
    file_.append({reinterpret_cast<const char*>(seal.data()), seal.size()});
    file_.overwrite(0, {reinterpret_cast<const char*>(&head_), sizeof head_});
    file_.commit();
  }

 private:
  void send() {
    send_piece(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void send_piece(const char* bytes, std::size_t n) {
    context_.check_stop();
    hash_.append(bytes_of(bytes, n));
    file_.append({bytes, n});
  }

  io::AtomicFile file_;
  const RunContext& context_;
  Head head_;
  ContentHash hash_;
  std::string buffer_;
};

/// Content that has been proved.
class FileSource final : public ByteSource {
 public:
  FileSource(const Descriptor& file, std::uint64_t n_bytes) : file_(file), n_left_(n_bytes) {}
  void take(void* bytes, std::size_t n) override {
    if (n > n_left_) refuse();
    auto* to = static_cast<char*>(bytes);
    while (n > 0) {
      if (begin_ == buffer_.size()) {
        buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(k_piece, n_left_)));
        if (!file_.read(buffer_.data(), buffer_.size(), at_)) refuse();
        at_ += buffer_.size();
        begin_ = 0;
      }
      const std::size_t part = std::min(n, buffer_.size() - begin_);
      std::memcpy(to, buffer_.data() + begin_, part);
      begin_ += part;
      n_left_ -= part;
      to += part;
      n -= part;
    }
  }
  std::uint64_t n_left() const override { return n_left_; }
  [[noreturn]] void refuse() const override { throw Error({.code = ErrorCode::file_malformed, .attempted = "reading an entry of the cache", .problem = "it does not hold what it should"}); }

 private:
  const Descriptor& file_;
  std::uint64_t n_left_;
  std::uint64_t at_ = sizeof(Head);
  std::string buffer_;
  std::size_t begin_ = 0;
};

/// What is wrong with the file as an entry of that key; empty when nothing is. Fills in the head.
std::string problem_of(const Descriptor& file, const ContentKey& key, Head& head, const RunContext& context) {
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) return std::generic_category().message(errno);
  const auto n_bytes = static_cast<std::uint64_t>(status.st_size);
  if (n_bytes < sizeof(Head) + sizeof(Seal) || !file.read(&head, sizeof head, 0)) return "it has " + std::to_string(n_bytes) + " bytes only";
  if (head.magic != k_magic || head.byte_order != k_byte_order) return "it is no entry of a cache";
  if (head.schema != k_schema) return "it is of layout " + std::to_string(head.schema) + ", not " + std::to_string(k_schema);
  if (head.key != key.bytes) return "it is of another key";
  if (head.n_bytes != n_bytes - sizeof(Head) - sizeof(Seal)) return "it has " + std::to_string(n_bytes) + " bytes in place of " + std::to_string(head.n_bytes + sizeof(Head) + sizeof(Seal));
  ContentHash hash;
  std::string piece(k_piece, '\0');
  for (std::uint64_t at = 0; at < head.n_bytes; at += k_piece) {
    context.check_stop();
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(k_piece, head.n_bytes - at));
    if (!file.read(piece.data(), n, sizeof(Head) + at)) return "it cannot be read: " + std::generic_category().message(errno);
    hash.append(bytes_of(piece.data(), n));
  }
  hash.append(bytes_of(&head, sizeof head));
  Seal seal{};
  if (!file.read(seal.data(), seal.size(), sizeof(Head) + head.n_bytes) || hash.digest() != seal) return "its content does not have the hash that it was stored with";
  return {};
}

void remove_damaged(const std::filesystem::path& path, std::string_view stage, const std::string& problem, const RunContext& context) {
  context.warn("cache: the entry " + path.string() + " of " + std::string(stage) + " is damaged (" + problem + "): it is removed and made anew");
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) context.warn("cache: " + path.string() + " could not be removed: " + error.message());
}

bool is_key_text(const std::string& text) { return text.size() == 2 * sizeof(Seal) && text.find_first_not_of("0123456789abcdef") == std::string::npos; }

/// A file of the cache as the file system has it.
struct Listed {
  std::filesystem::file_time_type used;
  std::filesystem::path file;
  std::uint64_t bytes = 0;
};

/// Other processes add and remove files meanwhile: what is gone is passed over.
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
  if (!std::filesystem::is_directory(folder, error)) throw Error({.code = ErrorCode::file_not_found, .attempted = "looking into the cache " + folder.string(), .problem = "there is no such folder"});
}

}  // namespace

StageCache::StageCache(CacheSettings settings) : settings_(std::move(settings)) {
  if (settings_.identity.empty()) settings_.identity = build_identity();
  std::error_code error;
  std::filesystem::create_directories(settings_.folder, error);
  if (!std::filesystem::is_directory(settings_.folder))
    throw Error({.code = ErrorCode::write_failed, .attempted = "making the cache " + settings_.folder.string(), .problem = error ? error.message() : "there is a file of that name", .hint = "name a folder"});
}

std::filesystem::path StageCache::path_of(std::string_view stage, const ContentKey& key) const {
  const std::string name = KeyMaker("entry").add(settings_.identity).add(k_schema).add(stage).add(key).key().hex();
  return settings_.folder / name.substr(0, 2) / (name + k_extension);
}

bool StageCache::find(std::string_view stage, const ContentKey& key, const std::function<void(ByteSource&)>& read, const RunContext& context) const {
  const std::filesystem::path path = path_of(stage, key);
  const Descriptor file(path);
  if (!file.is_open()) {
    if (errno != ENOENT) context.warn("cache: " + path.string() + " cannot be opened: " + std::generic_category().message(errno));
    return false;
  }
  ::flock(file.number(), LOCK_SH | LOCK_NB);  // held until the file is closed; without it the file could only go sooner than it should
  Head head;
  if (const std::string problem = problem_of(file, key, head, context); !problem.empty()) {
    remove_damaged(path, stage, problem, context);
    return false;
  }
  try {
    FileSource source(file, head.n_bytes);
    std::string name;
    read_value(source, name);
    if (name != stage) source.refuse();
    read(source);
    if (source.n_left() > 0) source.refuse();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::file_malformed) throw;
    remove_damaged(path, stage, error.info().problem, context);
    return false;
  }
  // When it was used last; where that cannot be written it only goes sooner than others.
  ::futimens(file.number(), nullptr);
  return true;
}

void StageCache::store(std::string_view stage, const ContentKey& key, const std::function<void(ByteSink&)>& write, const RunContext& context) const {
  const std::filesystem::path path = path_of(stage, key);
  try {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);  // AtomicFile says why where it cannot be
    FileSink sink(path, key, context);
    write_value(sink, std::string(stage));
    write(sink);
    sink.commit();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::write_failed) throw;
    context.warn("cache: the result of " + std::string(stage) + " is not kept: " + error.what());
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
    const Descriptor file(old.file);
    if (!file.is_open() || ::flock(file.number(), LOCK_EX | LOCK_NB) != 0) continue;  // gone, or somebody reads it
    std::error_code error;
    if (!std::filesystem::remove(old.file, error) && error) {
      context.warn("cache: " + old.file.string() + " could not be removed: " + error.message());
      continue;
    }
    bytes -= static_cast<double>(old.bytes);
    ++n_removed;
  }
  context.info("cache: above its limit, so " + std::to_string(n_removed) + " entries went that were not used for longest");
}

std::vector<CacheEntry> StageCache::entries(const std::filesystem::path& folder) {
  require_folder(folder);
  std::vector<CacheEntry> result;
  for (const Listed& file : listed(folder)) {
    CacheEntry entry{file.file, {}, file.bytes};
    const Descriptor open(file.file);
    Head head;
    if (open.is_open() && open.read(&head, sizeof head, 0) && head.magic == k_magic && head.schema == k_schema) {
      try {
        FileSource source(open, head.n_bytes);
        read_value(source, entry.stage);
      } catch (const Error&) {
        entry.stage.clear();  // as the contract says: damaged
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
