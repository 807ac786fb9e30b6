#include "scripting/series/case_status.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "geom/base/hash.h"
#include "io/output/atomic_file.h"
#include "scripting/lua/series_session.h"

namespace sterna::scripting {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* k_schema = "sterna-case-1";
constexpr CaseState k_states[] = {CaseState::none, CaseState::running, CaseState::done, CaseState::failed, CaseState::killed};

Json locations_json(const std::vector<ErrorLocation>& locations) {
  Json list = Json::array();
  for (const ErrorLocation& location : locations)
    list.push_back({{"at", {location.position.x, location.position.y, location.position.z}}, {"what", location.what}});
  return list;
}

Json json_of(const CaseStatus& status) {
  Json json = {{"schema", k_schema}, {"status", to_string(status.state)}, {"key", status.key}};
  if (status.state == CaseState::running) json["process"] = {{"pid", status.process}, {"host", status.host}};
  if (status.state == CaseState::failed) json["error"] = {{"code", status.code}, {"message", status.message}, {"places", locations_json(status.locations)}};
  if (status.is_of_machine && status.state == CaseState::failed) json["error"]["of_machine"] = true;
  if (status.state == CaseState::killed) json["killed"] = status.message;
  if (status.state == CaseState::done) {
    json["mesh"] = status.mesh.verdict.empty()
                       ? Json(nullptr)
                       : Json{{"verdict", status.mesh.verdict}, {"cells", status.mesh.cells}, {"quality", status.mesh.quality}, {"worst", status.mesh.worst}};
    json["result"] = Json::parse(status.result);
  }
  if (!status.inputs.empty()) json["inputs"] = status.inputs;
  if (!status.outputs.empty()) json["outputs"] = status.outputs;
  if (!status.found.empty()) json["not_of_the_case"] = status.found;
  return json;
}

CaseStatus status_of(const Json& json) {
  CaseStatus status;
  const auto state = json.at("status").get<std::string>();
  for (const CaseState known : k_states)
    if (to_string(known) == state) status.state = known;
  status.key = json.at("key");
  if (const auto it = json.find("inputs"); it != json.end()) status.inputs = it->get<std::map<std::string, std::string>>();
  if (const auto it = json.find("outputs"); it != json.end()) status.outputs = it->get<std::map<std::string, std::string>>();
  if (const auto it = json.find("not_of_the_case"); it != json.end()) status.found = it->get<std::vector<std::string>>();
  if (const auto it = json.find("process"); it != json.end()) {
    status.process = it->at("pid");
    status.host = it->at("host");
  }
  if (status.state == CaseState::killed) status.message = json.at("killed");
  if (status.state == CaseState::done) {
    if (const Json& mesh = json.at("mesh"); !mesh.is_null())
      status.mesh = {.verdict = mesh.at("verdict"), .cells = mesh.at("cells"), .quality = mesh.at("quality"), .worst = mesh.at("worst")};
    status.result = json.at("result").dump();
  }
  if (status.state == CaseState::failed) {
    const Json& error = json.at("error");
    status.code = error.at("code");
    status.message = error.at("message");
    status.is_of_machine = error.value("of_machine", false);
    for (const Json& location : error.at("places"))
      status.locations.push_back({{location.at("at").at(0), location.at("at").at(1), location.at("at").at(2)}, location.at("what")});
  }
  return status;
}

bool is_bookkeeping(const std::string& name) { return name == k_status_file || name == k_measure_file || name == k_log_file; }
bool is_leftover(const fs::path& path) { return path.filename().string().starts_with(".sterna-") && path.extension() == ".part"; }

/// Returns the regular files and links below the folder, by their relative names, in ascending order.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code failure;
  for (fs::recursive_directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure))
    if (!it->is_directory() || it->is_symlink()) files.push_back(it->path().lexically_relative(folder).generic_string());
  if (failure && fs::exists(folder)) throw Error({.code = ErrorCode::write_failed, .attempted = "listing " + folder.string(), .problem = failure.message()});
  std::sort(files.begin(), files.end());
  return files;
}

void remove_file(const fs::path& path) {
  std::error_code failure;
  fs::remove(path, failure);
  if (failure) throw Error({.code = ErrorCode::write_failed, .attempted = "removing " + path.string() + " of an earlier run", .problem = failure.message()});
}

}  // namespace

std::string_view to_string(CaseState state) {
  switch (state) {
    case CaseState::none: return "none";
    case CaseState::running: return "running";
    case CaseState::done: return "done";
    case CaseState::failed: return "failed";
    case CaseState::killed: return "killed";
  }
  return "none";
}

CaseStatus read_status(const fs::path& folder, const RunContext& context) {
  std::ifstream file(folder / k_status_file, std::ios::binary);
  if (!file) return {};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {
    const Json json = Json::parse(text);
    if (json.at("schema") == k_schema) return status_of(json);
    context.warn((folder / k_status_file).string() + " was written by another version: the case runs again");
  } catch (const nlohmann::json::exception& error) {
    context.warn((folder / k_status_file).string() + " is damaged (" + error.what() + "): the case runs again");
  }
  return {};
}

void write_status(const CaseStatus& status, const fs::path& folder) {
  io::write_whole(folder / k_status_file, json_of(status).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

bool is_current(const CaseStatus& status, const fs::path& folder, const std::string& key) {
  if (!status.is_final() || status.key != key) return false;
  for (const auto& [name, hash] : status.inputs)
    if (hash_of_input(name) != hash) return false;
  for (const auto& [name, hash] : status.outputs)
    if (!fs::is_regular_file(folder / name) || hash_file(folder / name) != hash) return false;
  return true;
}

std::map<std::string, std::string> outputs_in(const fs::path& folder, const std::vector<std::string>& found) {
  std::map<std::string, std::string> outputs;
  for (const std::string& name : files_in(folder)) {
    if (is_bookkeeping(name) || is_leftover(name) || std::binary_search(found.begin(), found.end(), name)) continue;
    if (fs::is_regular_file(fs::symlink_status(folder / name))) outputs[name] = hash_file(folder / name);
  }
  return outputs;
}

std::vector<std::string> clear_case_folder(const fs::path& folder, const CaseStatus& before) {
  const bool has_died = before.state == CaseState::running || before.state == CaseState::killed;
  std::vector<std::string> others;
  for (const std::string& name : files_in(folder)) {
    const bool is_foreign = std::find(before.found.begin(), before.found.end(), name) != before.found.end();
    const bool is_own = is_leftover(name) || before.outputs.contains(name) || (has_died && !is_foreign);
    if (is_bookkeeping(name)) continue;
    if (is_own && !is_foreign) remove_file(folder / name);
    else others.push_back(name);
  }
  return others;
}

void remove_parts(const fs::path& folder) {
  for (const std::string& name : files_in(folder))
    if (is_leftover(name) && name.find('/') == std::string::npos) remove_file(folder / name);
}

std::string signal_text(int signal) {
  const char* name = sigdescr_np(signal);
  return "signal " + std::to_string(signal) + (name ? " (" + std::string(name) + ")" : "");
}

}  // namespace sterna::scripting
