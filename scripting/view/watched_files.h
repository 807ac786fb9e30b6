// Detects changes of the files on which a script depends, by polling.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sterna::scripting {

/// A script, and the files that it names in quotes. A file may be named by its path, be beside the script, or be a module NAME.lua beside it. Only files that
/// existed at the script's last change count, so a file that the script writes under a name that it does not read gives no reason to run again.
class WatchedFiles {
 public:
  /// \p other an additional file to watch
  WatchedFiles(std::filesystem::path script, std::filesystem::path other);
  /// Returns true if the script's text or a file has changed since the last call, and has then been stable for one call, so that a file that is being written
  /// is complete. Saving unchanged content is not a change of the script.
  bool have_changed();
  /// Accepts the current state of other files as unchanged: the run that has just ended wrote them.
  void accept_others();

 private:
  struct File {
    std::filesystem::path path;
    std::int64_t stamp = 0;  ///< time of the last change; the size of the file is compared, too
    std::uintmax_t size = 0;
    friend bool operator==(const File&, const File&) = default;
  };
  static File seen(const std::filesystem::path& path);
  void find_files(const std::string& text);

  std::filesystem::path script_, other_;
  std::string text_;
  std::vector<File> files_, pending_;
};

}  // namespace sterna::scripting
