// Converts the bytes of a fuzz input to the files that a reader opens: one file, or several joined ones if the reader opens companion files or reads a folder.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/format_table.h"
#include "tests/fuzz/model_readers.h"

namespace sterna::fuzz {

/// A reader from the table of formats, or a reader of model files.
struct Target {
  const io::Format* format = nullptr;  ///< the first entry with that reader; null for a model file
  bool is_volume = false;
  std::string extensions;  ///< extensions that the reader treats alike; blank-separated
  const ModelReader* model = nullptr;

  std::string_view extension() const { return std::string_view(extensions).substr(0, extensions.find(' ')); }
  bool is_folder() const { return !extensions.starts_with('.'); }

  /// "UGRID:volume:.lb8.ugrid", "CPACS:model:.xml"
  std::string name() const;
};

/// Returns the blank-separated words.
std::vector<std::string_view> words(std::string_view text);

/// Returns every reader once; a reader that depends on the extension once for each extension.
std::vector<Target> all_targets();

/// The files of one input, in an in-memory folder if the system has one; removed at the end. Parts are separated by k_part_end, in the order main file,
/// companions.
class InputFiles {
 public:
  explicit InputFiles(const Target& target);
  ~InputFiles();
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;

  /// Writes the parts; companions beyond the parts are removed.
  void fill(std::string_view bytes) const;
  /// Path to pass to the reader.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_, path_;
  std::vector<std::filesystem::path> parts_;
};

inline constexpr std::string_view k_part_end = "\n%%%%%%%%\n";

/// Returns the input that would create `path` and the companions beside it (a folder: its files); empty if nothing can be read.
std::string joined(const Target& target, const std::filesystem::path& path);

}  // namespace sterna::fuzz
