#include "io/input/file_buffer.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "geom/base/error.h"

namespace sterna::io {
namespace {

/// Maximum ratio of unpacked to packed size. Mesh text reaches about 10, repetitive test files 50. Deflate itself allows 1032, which only decompression bombs
/// reach.
constexpr std::size_t k_max_expansion = 200;
/// Number of bytes that may be unpacked regardless of the packed size: small files of zeros are harmless.
constexpr std::size_t k_gzip_expansion_floor = std::size_t{1} << 24;
/// Bytes per call of read or inflate; the stop request is checked between calls.
constexpr std::size_t k_piece = std::size_t{1} << 22;
constexpr std::size_t k_longest_excerpt = 40;

[[noreturn]] void throw_file(ErrorCode code, std::string_view source, std::string problem, std::string_view hint = {}) {
  throw Error({.code = code, .attempted = "reading " + std::string(source), .problem = std::move(problem), .hint = std::string(hint)});
}

std::vector<char> read_all(const std::filesystem::path& path, const std::string& source, const RunContext& context) {
  std::error_code status;
  if (!std::filesystem::exists(path, status)) throw_file(ErrorCode::file_not_found, source, "there is no such file");
  if (std::filesystem::is_directory(path, status)) throw_file(ErrorCode::file_not_found, source, "this is a folder, not a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw_file(ErrorCode::file_not_found, source, "the file cannot be opened: " + std::generic_category().message(errno));

  std::vector<char> bytes;
  const std::uintmax_t size = std::filesystem::file_size(path, status);  // the size of a pipe is unknown; the vector then grows
  if (!status) bytes.reserve(static_cast<std::size_t>(size) + 1);        // one more, to detect the end without growing
  for (;;) {
    context.check_stop();
    const std::size_t n_before = bytes.size();
    const std::size_t n_free = bytes.capacity() - n_before;
    bytes.resize(n_before + std::max<std::size_t>(1, std::min(k_piece, n_free > 0 ? n_free : n_before + 4096)));
    const std::size_t n_read = std::fread(bytes.data() + n_before, 1, bytes.size() - n_before, file.get());
    bytes.resize(n_before + n_read);
    if (n_read == 0) break;
  }
  if (std::ferror(file.get())) throw_file(ErrorCode::file_not_found, source, "the file cannot be read: " + std::generic_category().message(errno));
  return bytes;
}

bool is_gzip(const std::vector<char>& bytes) {
  return bytes.size() >= 2 && static_cast<unsigned char>(bytes[0]) == 0x1f && static_cast<unsigned char>(bytes[1]) == 0x8b;
}

std::vector<char> unpack(const std::vector<char>& packed, const std::string& source, const RunContext& context) {
  struct Stream : z_stream {
    Stream() : z_stream{} {}
    ~Stream() { inflateEnd(this); }
  } stream;
  constexpr int k_gzip_window = 15 + 16;
  if (inflateInit2(&stream, k_gzip_window) != Z_OK) throw_file(ErrorCode::internal, source, "zlib cannot be started");

  const std::size_t limit = std::max(k_gzip_expansion_floor, k_max_expansion * packed.size());
  std::vector<char> bytes;
  std::size_t n_fed = 0;
  bool is_complete = false;
  const auto where = [&] { return "byte " + std::to_string(n_fed - stream.avail_in) + " of the packed file"; };
  while (!is_complete) {
    context.check_stop();
    if (stream.avail_in == 0 && n_fed < packed.size()) {
      const std::size_t n = std::min(k_piece, packed.size() - n_fed);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + n_fed));
      stream.avail_in = static_cast<uInt>(n);
      n_fed += n;
    }
    const std::size_t n_before = bytes.size();
    const std::size_t n_piece = std::min(k_piece, std::max<std::size_t>(4 * packed.size(), 4096));
    bytes.resize(n_before + n_piece);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + n_before);
    stream.avail_out = static_cast<uInt>(n_piece);
    const int state = inflate(&stream, Z_NO_FLUSH);
    bytes.resize(bytes.size() - stream.avail_out);
    if (bytes.size() > limit)
      throw_malformed(source, where(), "the gzip data unpacks to more than " + std::to_string(limit) + " bytes, too much for a mesh file");
    if (state == Z_STREAM_END) {
      // Another member may follow directly; padding with zeros (tapes, block devices) is ignored as in gzip.
      const auto rest = packed.begin() + static_cast<std::ptrdiff_t>(n_fed - stream.avail_in);
      if (std::all_of(rest, packed.end(), [](char c) { return c == '\0'; })) is_complete = true;
      else inflateReset(&stream);
    } else if (state == Z_BUF_ERROR || (state == Z_OK && stream.avail_in == 0 && n_fed == packed.size() && stream.avail_out > 0)) {
      throw_malformed(source, where(), "the gzip data ends too early", "copy or download the file again");
    } else if (state != Z_OK) {
      throw_malformed(source, where(), std::string("the gzip data is damaged (") + (stream.msg ? stream.msg : "zlib error") + ")",
                      "copy or download the file again");
    }
  }
  return bytes;
}

}  // namespace

FileBuffer load_file(const std::filesystem::path& path, const RunContext& context) {
  FileBuffer buffer{.source = path.string(), .bytes = {}};
  buffer.bytes = read_all(path, buffer.source, context);
  if (is_gzip(buffer.bytes)) buffer.bytes = unpack(buffer.bytes, buffer.source, context);
  if (buffer.bytes.empty()) throw_file(ErrorCode::file_malformed, buffer.source, "the file is empty");
  return buffer;
}

std::string file_head(const std::filesystem::path& path, std::size_t n_bytes) {
  std::error_code status;
  if (!std::filesystem::is_regular_file(path, status)) return {};                               // a pipe can be read only once
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), &gzclose);  // also opens plain files
  if (!file) return {};
  std::string head(n_bytes, '\0');
  head.resize(static_cast<std::size_t>(std::max(0, gzread(file.get(), head.data(), static_cast<unsigned>(n_bytes)))));
  return head;
}

std::string quoted_excerpt(std::string_view bytes) {
  std::string text = "\"";
  for (const char c : bytes.substr(0, k_longest_excerpt)) {
    if (c >= ' ' && c <= '~') {
      text += c;
    } else {
      char hex[8];
      std::snprintf(hex, sizeof hex, "\\x%02x", static_cast<unsigned char>(c));
      text += hex;
    }
  }
  if (bytes.size() > k_longest_excerpt) text += "...";
  return text + "\"";
}

void throw_malformed(std::string_view source, std::string_view where, std::string_view problem, std::string_view hint) {
  throw_file(ErrorCode::file_malformed, source, std::string(where) + ": " + std::string(problem), hint);
}

void throw_unsupported(std::string_view source, std::string_view problem, std::string_view hint) {
  throw_file(ErrorCode::unsupported_format, source, std::string(problem), hint);
}

}  // namespace sterna::io
