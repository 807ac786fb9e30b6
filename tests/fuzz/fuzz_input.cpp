#include "tests/fuzz/fuzz_input.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/fuzz/container_input.h"

namespace sterna::fuzz {
namespace {

struct Companions {
  std::string_view format, endings;  ///< blank-separated
};
/// Companion files that readers open beside a file x.EXTENSION: x + ending.
constexpr Companions k_companions[] = {{"UGRID", ".mapbc"}, {"TAU", ".bmap"}, {"Edge", ".aboc"}, {"Medit", ".names"}, {"TetGen smesh", ".node"}};
/// Formats whose variants are chosen by the extension; all others are recognised by the file content.
constexpr Companions k_variants[] = {{"UGRID", ".lb8.ugrid .b8l.ugrid .lb4.ugrid .ugrid"}, {"TetGen smesh", ".smesh .poly"}, {"OpenFOAM", "polymesh"}};
constexpr const char* k_folder_files[] = {"points", "faces", "owner", "neighbour", "boundary"};

std::string_view entry(std::span<const Companions> table, std::string_view format) {
  for (const Companions& row : table)
    if (row.format == format) return row.endings;
  return {};
}

std::string_view companions_of(const Target& target) { return target.format ? entry(k_companions, target.format->name) : std::string_view(); }

void write(const std::filesystem::path& path, std::string_view bytes) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fclose(file) != 0) std::abort();
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> result;
  for (std::size_t begin = text.find_first_not_of(' '); begin != std::string_view::npos; begin = text.find_first_not_of(' ', begin)) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    result.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return result;
}

std::string Target::name() const {
  if (model) return std::string(model->name) + ":model:" + std::string(model->extension);
  return std::string(format->name) + (is_volume ? ":volume:" : ":surface:") + std::string(extension());
}

std::vector<Target> all_targets() {
  std::vector<Target> targets;
  for (const bool is_volume : {false, true}) {
    for (const io::Format& format : io::formats()) {
      if (is_volume ? !format.read_volume : !format.read_surface) continue;
      const auto same = std::find_if(targets.begin(), targets.end(), [&](const Target& target) {
        return target.is_volume == is_volume &&
               (is_volume ? target.format->read_volume == format.read_volume : target.format->read_surface == format.read_surface);
      });
      const std::vector<std::string_view> variants = words(entry(k_variants, format.name));
      for (const std::string_view extension : variants) targets.push_back({&format, is_volume, std::string(extension)});
      if (variants.empty() && same == targets.end()) targets.push_back({&format, is_volume, std::string(format.extensions)});
      else if (variants.empty() && entry(k_variants, same->format->name).empty()) same->extensions += " " + std::string(format.extensions);
    }
  }
  for (const ModelReader& reader : model_readers()) targets.push_back({.format = nullptr, .extensions = std::string(reader.extension), .model = &reader});
  return targets;
}

InputFiles::InputFiles(const Target& target) {
  const std::filesystem::path memory = "/dev/shm";
  folder_ = (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) / ("sterna_fuzz_" + std::to_string(getpid()));
  path_ = target.is_folder() ? folder_ / "constant" / "polyMesh" : folder_ / ("x" + std::string(target.extension()));
  std::filesystem::create_directories(target.is_folder() ? path_ : folder_);
  if (target.is_folder()) {
    for (const char* name : k_folder_files) parts_.push_back(path_ / name);
  } else {
    parts_.push_back(path_);
    for (const std::string_view ending : words(companions_of(target))) parts_.push_back(folder_ / ("x" + std::string(ending)));
  }
}

InputFiles::~InputFiles() {
  std::error_code ignored;  // at worst a few kB remain in memory
  std::filesystem::remove_all(folder_, ignored);
}

void InputFiles::fill(std::string_view bytes) const {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const std::size_t end = k + 1 < parts_.size() ? std::min(bytes.find(k_part_end), bytes.size()) : bytes.size();
    const bool is_there = k == 0 || !bytes.empty();
    if (is_there) write(parts_[k], bytes.substr(0, end));
    else std::remove(parts_[k].c_str());
    bytes.remove_prefix(std::min(end + k_part_end.size(), bytes.size()));
  }
}

std::string joined(const Target& target, const std::filesystem::path& path) {
  std::string bytes;
  if (target.is_folder()) {
    for (const char* name : k_folder_files) bytes += (bytes.empty() ? "" : std::string(k_part_end)) + content(path / name);
    return bytes;
  }
  bytes = is_container(target) ? image_of(target, path) : content(path);
  for (const std::string_view ending : words(companions_of(target))) {
    std::filesystem::path stem = path;
    std::string companion;
    for (int n_dots = 0; n_dots < 2 && companion.empty() && stem.has_extension(); ++n_dots) {  // wing.lb8.ugrid has wing.mapbc
      stem.replace_extension();
      companion = content(stem.string() + std::string(ending));
    }
    bytes += std::string(k_part_end) + companion;
  }
  while (bytes.ends_with(k_part_end)) bytes.resize(bytes.size() - k_part_end.size());
  return bytes;
}

}  // namespace sterna::fuzz
