// Reader of one OpenFOAM file: its header, then lists in text or binary.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "io/input/file_buffer.h"

namespace sterna::io {

/// Returns `path`.gz if it exists and `path` does not, else `path`.
std::filesystem::path packed_or_plain(const std::filesystem::path& path);

/// Reading members throw Error file_malformed with the line (the byte inside binary lists).
class FoamFile {
 public:
  /// Loads `path`, or `path`.gz, and reads the header. \param object_class the class required in the header ("labelList"); alternatives are separated by blanks
  FoamFile(const std::filesystem::path& path, std::string_view object_class, const RunContext& context);

  const std::string& object_class() const { return class_; }
  const std::string& source() const { return buffer_.source; }

  /// Reads a list of labels. \param limit maximum length of the list; every label must be in [0, label_limit)
  std::vector<std::uint32_t> labels(std::string_view expected, std::uint64_t limit, std::uint64_t label_limit);
  /// Reads a list of finite vectors.
  std::vector<Vec3> vectors(std::string_view expected);
  /// Reads a faceList, a list of lists of labels, in text. Returns the nodes of all lists and the start of each list.
  void label_lists(std::string_view expected, std::uint64_t label_limit, std::vector<std::uint32_t>& values, std::vector<std::uint64_t>& first);
  /// Reads a faceCompactList, which has the same data as two lists.
  void compact_label_lists(std::string_view expected, std::uint64_t label_limit, std::vector<std::uint32_t>& values, std::vector<std::uint64_t>& first);

  /// Returns the next word, string (without its quotes) or single character of ( ) { } ; ; empty at the end of the file.
  std::string_view token();
  /// Consumes the given token.
  void expect(std::string_view required);
  std::uint64_t count(std::string_view expected, std::size_t min_bytes);
  std::int64_t integer(std::string_view expected);
  /// Throws an error located at the last token read.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  void read_header(std::string_view object_class);
  void read_arch(std::string_view arch);
  void skip_space();
  std::string_view peek();
  double real(std::string_view expected);
  /// Begins a binary list of n items of that size: consumes "(".
  void begin_bytes(std::uint64_t n, std::size_t size, std::string_view expected);
  void end_bytes();
  std::int64_t take_label();
  double take_scalar();
  std::uint32_t checked(std::int64_t label, std::string_view expected, std::uint64_t limit) const;

  FileBuffer buffer_;
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t token_begin_ = 0;
  std::string class_;
  bool is_binary_ = false;
  std::endian order_ = std::endian::little;
  std::size_t label_size_ = 4;
  std::size_t scalar_size_ = 8;
};

}  // namespace sterna::io
