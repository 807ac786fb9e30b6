#include "io/names/tau_mapping.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>

#include "io/input/text_scanner.h"
#include "io/names/patch_names.h"

namespace sterna::io {
namespace {

std::string_view trimmed_word(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

/// Parses "1, 4, 7".
std::vector<std::int64_t> numbers_of(std::string_view list, const FileBuffer& buffer, const std::string& where) {
  std::vector<std::int64_t> numbers;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(','), list.size());
    const std::string_view word = trimmed_word(list.substr(0, end));
    std::int64_t number = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), number);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size())
      throw_malformed(buffer.source, where, "found the marker " + quoted_excerpt(word) + ", expected a number");
    numbers.push_back(number);
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return numbers;
}

}  // namespace

std::filesystem::path bmap_path(const std::filesystem::path& mesh_path) {
  std::filesystem::path path = mesh_path;
  if (equal_ignoring_case(path.extension().string(), ".gz")) path.replace_extension();
  return path.replace_extension(".bmap");
}

std::map<std::int64_t, TauMarker> read_bmap(const std::filesystem::path& mesh_path, const RunContext& context) {
  std::map<std::int64_t, TauMarker> markers;
  std::error_code status;  // if the file cannot be accessed; load_file reports the error of an existing file
  const std::filesystem::path path = bmap_path(mesh_path);
  if (!std::filesystem::exists(path, status)) return markers;
  const FileBuffer buffer = load_file(path, context);
  std::vector<std::int64_t> numbers;
  TauMarker block;
  const auto end_block = [&] {
    for (const std::int64_t number : numbers) markers[number] = {.number = number, .name = block.name, .condition = block.condition};
    numbers.clear();
    block = {};
  };
  std::string_view rest = buffer.text();
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, std::min(end, rest.find('#')));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (trimmed_word(line) == "block end") end_block();
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string_view key = trimmed_word(line.substr(0, colon)), value = trimmed_word(line.substr(colon + 1));
    if (key == "Markers") {
      if (!numbers.empty()) end_block();
      numbers = numbers_of(value, buffer, "line " + std::to_string(line_number));
    } else if (key == "Type") {
      block.condition = value;
    } else if (key == "Name") {
      block.name = value;
    }
  }
  end_block();
  return markers;
}

std::string bmap_text(const std::vector<TauMarker>& markers) {
  std::string text = " -----------------------------------------------------\n BOUNDARY MAPPING\n -----------------------------------------------------\n";
  for (const TauMarker& marker : markers) {
    text += "\n                  Markers: " + std::to_string(marker.number) + "\n                     Type: " + marker.condition +
            "\n                     Name: " + marker.name + "\n";
    // With this flag TAU writes values on the surface.
    if (marker.condition.ends_with("wall")) text += " Write surface data (0/1): 1\n";
    text += "\n block end\n ---------------------------\n";
  }
  return text;
}

std::string tau_condition(PatchKind kind) {
  switch (kind) {
    case PatchKind::wall: return "viscous wall";
    case PatchKind::slip: return "euler wall";
    case PatchKind::symmetry: return "symmetry plane";
    case PatchKind::inflow: return "engine exhaust";  // flow enters the domain from the engine
    case PatchKind::outflow: return "engine inflow";  // flow leaves the domain into the engine
    case PatchKind::farfield: return "farfield";
    case PatchKind::interface: break;
  }
  return "euler wall";
}

PatchKind kind_of_tau(const TauMarker& marker) {
  const std::string& condition = marker.condition;
  if (condition == "euler wall") return PatchKind::slip;
  if (condition.ends_with("wall")) return PatchKind::wall;
  if (condition == "symmetry plane" || condition == "mirror plane") return PatchKind::symmetry;
  if (condition == "farfield") return PatchKind::farfield;
  if (condition == "engine inflow" || condition == "heat exchanger inflow" || condition.ends_with("pressure outflow") || condition == "supersonic outflow")
    return PatchKind::outflow;
  if (condition == "engine exhaust" || condition == "heat exchanger outflow" || condition.ends_with("pressure inflow") || condition == "supersonic inflow")
    return PatchKind::inflow;
  return kind_of_name(marker.name);
}

}  // namespace sterna::io
