// The bytes that a fuzz target is given, as the files that a reader opens: one file, or several joined where the reader looks for companions or reads a folder.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/format_table.h"
#include "tests/fuzz/model_readers.h"

namespace sterna::fuzz {

/// A reader of the table of formats, or one of a model's files.
struct Target {
  const io::Format* format = nullptr;  ///< the first line with that reader; null of a model's file
  bool is_volume = false;
  std::string extensions;  ///< of files that it reads alike; blank-separated
  const ModelReader* model = nullptr;

  std::string_view extension() const { return std::string_view(extensions).substr(0, extensions.find(' ')); }
  bool is_folder() const { return !extensions.starts_with('.'); }

  /// "UGRID:volume:.lb8.ugrid", "CPACS:model:.xml"
  std::string name() const;
};

/// The blank-separated words.
std::vector<std::string_view> words(std::string_view text);

/// Every reader once; one that goes by the extension once for each.
std::vector<Target> all_targets();

/// The files of one input, in memory where the system has such a folder; removed at the end. Parts are separated by k_part_end, in the order main file,
/// companions.
class InputFiles {
 public:
  explicit InputFiles(const Target& target);
  ~InputFiles();
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;

  /// Writes the parts; companions beyond the parts are removed.
  void fill(std::string_view bytes) const;
  /// What the reader is given.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_, path_;
  std::vector<std::filesystem::path> parts_;
};

inline constexpr std::string_view k_part_end = "\n%%%%%%%%\n";

/// The input that would make `path` and the companions beside it (a folder: its files). \returns an empty one where nothing can be read
std::string joined(const Target& target, const std::filesystem::path& path);

}  // namespace sterna::fuzz
