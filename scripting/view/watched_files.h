// The files that a script depends on, looked at now and then.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sterna::scripting {

/// A script, and the files that it names in quotes: as they are, beside it, or as a module NAME.lua beside it. A file that the script writes itself under a
/// name that it does not read is no reason to run again: only files that were there when the script was last seen to change count.
class WatchedFiles {
 public:
  /// \p other a file that counts, too
  WatchedFiles(std::filesystem::path script, std::filesystem::path other);
  /// Whether the script's text or a file has changed since the last time, and has not for one look: a file that is being written is waited for. The same
  /// content saved again is no change of the script.
  bool have_changed();
  /// What other files are now is no change: the run that has just ended wrote them.
  void accept_others();

 private:
  struct File {
    std::filesystem::path path;
    std::int64_t stamp = 0;  ///< of its last change; size counts, too
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
