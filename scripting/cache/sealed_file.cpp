#include "scripting/cache/sealed_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <system_error>

#include "geom/base/error.h"
#include "geom/base/hash.h"
#include "io/output/atomic_file.h"

namespace sterna::scripting {
namespace {

constexpr std::uint32_t k_byte_order = 0x01020304;
constexpr std::array<char, 16> k_magic = {'\x89', 's', 't', 'a', 'g', 'e', '\r', '\n', '\x1a', '\n', 0, 0, 0, 0, 0, 0};
constexpr std::size_t k_piece = 1 << 20;  ///< bytes per system call

struct Head {
  std::array<char, 16> magic = k_magic;
  std::uint32_t schema = k_sealed_schema;
  std::uint32_t byte_order = k_byte_order;
  std::array<std::uint8_t, 16> key{};
  std::uint64_t n_bytes = 0;
};
static_assert(sizeof(Head) == 48);
using Seal = std::array<std::uint8_t, 16>;

std::span<const std::byte> bytes_of(const void* at, std::size_t n) { return {static_cast<const std::byte*>(at), n}; }

/// Returns false if the file ends before.
bool read(int descriptor, void* to, std::size_t n, std::uint64_t from) {
  auto* at = static_cast<char*>(to);
  while (n > 0) {
    const ssize_t got = ::pread(descriptor, at, n, static_cast<off_t>(from));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    from += static_cast<std::uint64_t>(got);
    n -= static_cast<std::size_t>(got);
  }
  return true;
}

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

/// Verified content.
class FileSource final : public ByteSource {
 public:
  FileSource(int descriptor, std::uint64_t n_bytes) : descriptor_(descriptor), n_left_(n_bytes) {}
  void take(void* bytes, std::size_t n) override {
    if (n > n_left_) refuse();
    auto* to = static_cast<char*>(bytes);
    while (n > 0) {
      if (begin_ == buffer_.size()) {
        buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(k_piece, n_left_)));
        if (!read(descriptor_, buffer_.data(), buffer_.size(), at_)) refuse();
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
  [[noreturn]] void refuse() const override {
    throw Error({.code = ErrorCode::file_malformed, .attempted = "reading a file of the cache", .problem = "the content differs from the expected structure"});
  }

 private:
  int descriptor_;
  std::uint64_t n_left_;
  std::uint64_t at_ = sizeof(Head);
  std::string buffer_;
  std::size_t begin_ = 0;
};

}  // namespace

void write_sealed(const std::filesystem::path& path, const ContentKey& key, const std::function<void(ByteSink&)>& write, const RunContext& context) {
  FileSink sink(path, key, context);
  write(sink);
  sink.commit();
}

SealedFile::SealedFile(const std::filesystem::path& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}

SealedFile::~SealedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string SealedFile::problem(const ContentKey& key, const RunContext& context) {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) return std::generic_category().message(errno);
  const auto n_bytes = static_cast<std::uint64_t>(status.st_size);
  Head head;
  if (n_bytes < sizeof(Head) + sizeof(Seal) || !read(descriptor_, &head, sizeof head, 0)) return "it has " + std::to_string(n_bytes) + " bytes only";
  if (head.magic != k_magic || head.byte_order != k_byte_order) return "it is not a cache file of sterna";
  if (head.schema != k_sealed_schema) return "it has the layout version " + std::to_string(head.schema) + ", not " + std::to_string(k_sealed_schema);
  if (head.key != key.bytes) return "it has another key";
  if (head.n_bytes != n_bytes - sizeof(Head) - sizeof(Seal))
    return "it has " + std::to_string(n_bytes) + " bytes instead of " + std::to_string(head.n_bytes + sizeof(Head) + sizeof(Seal));
  ContentHash hash;
  std::string piece(k_piece, '\0');
  for (std::uint64_t at = 0; at < head.n_bytes; at += k_piece) {
    context.check_stop();
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(k_piece, head.n_bytes - at));
    if (!read(descriptor_, piece.data(), n, sizeof(Head) + at)) return "it cannot be read: " + std::generic_category().message(errno);
    hash.append(bytes_of(piece.data(), n));
  }
  hash.append(bytes_of(&head, sizeof head));
  Seal seal{};
  if (!read(descriptor_, seal.data(), seal.size(), sizeof(Head) + head.n_bytes) || hash.digest() != seal) return "its content does not match the stored hash";
  seal_.bytes = seal;
  n_bytes_ = head.n_bytes;
  return {};
}

bool SealedFile::has_head() {
  Head head;
  if (!is_open() || !read(descriptor_, &head, sizeof head, 0) || head.magic != k_magic || head.schema != k_sealed_schema) return false;
  n_bytes_ = head.n_bytes;
  return true;
}

std::unique_ptr<ByteSource> SealedFile::content() const { return std::make_unique<FileSource>(descriptor_, n_bytes_); }

}  // namespace sterna::scripting
