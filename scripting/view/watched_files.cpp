#include "scripting/view/watched_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace sterna::scripting {
namespace {

/// Maximum length of a file name.
constexpr std::size_t k_longest_name = 300;

std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the strings in quotes.
std::vector<std::string> quoted_names(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; (at = text.find_first_of("\"'", at)) != std::string::npos;) {
    const std::size_t end = text.find_first_of(std::string(1, text[at]) + "\n", at + 1);
    if (end == std::string::npos) break;
    if (text[end] != '\n' && end > at + 1 && end - at < k_longest_name) names.push_back(text.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

WatchedFiles::WatchedFiles(std::filesystem::path script, std::filesystem::path other) : script_(std::move(script)), other_(std::move(other)) {
  text_ = text_of_file(script_);
  find_files(text_);
}

WatchedFiles::File WatchedFiles::seen(const std::filesystem::path& path) {
  std::error_code error;
  File file{.path = path};
  if (!std::filesystem::is_regular_file(path, error)) return file;
  const auto time = std::filesystem::last_write_time(path, error);
  file.stamp = error ? 0 : static_cast<std::int64_t>(time.time_since_epoch().count());
  file.size = std::filesystem::file_size(path, error);
  return file;
}

void WatchedFiles::find_files(const std::string& text) {
  files_ = {seen(script_)};
  if (other_ != script_) files_.push_back(seen(other_));
  const std::filesystem::path beside = script_.parent_path();
  for (const std::string& name : quoted_names(text))
    for (const std::filesystem::path& path : {std::filesystem::path(name), beside / name, beside / (name + ".lua")}) {
      std::error_code error;
      if (path.empty() || !std::filesystem::is_regular_file(path, error)) continue;
      files_.push_back(seen(path));
      break;
    }
  pending_ = files_;
}

void WatchedFiles::accept_others() {
  for (File& file : files_)
    if (file.path != script_) file = seen(file.path);
  pending_ = files_;
}

bool WatchedFiles::have_changed() {
  std::vector<File> now;
  for (const File& file : files_) now.push_back(seen(file.path));
  if (now == files_) return false;
  if (now != std::exchange(pending_, now)) return false;  // wait, because the file may still be being written
  if (now.front().stamp == 0) return false;               // wait, because an editor is about to replace the file
  std::string text = text_of_file(script_);
  const bool is_other = text != text_ || !std::equal(now.begin() + 1, now.end(), files_.begin() + 1);
  text_ = std::move(text);
  find_files(text_);
  return is_other;
}

}  // namespace sterna::scripting
