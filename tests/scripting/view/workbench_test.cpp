// The workbench without a browser: the program, the requests of its page, a script that is changed meanwhile.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "geom/base/child_process.h"
#include "scripting/view/view_page.h"
#include "tests/scripting/view/raw_http.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::test {
namespace {

using ViewJson = nlohmann::ordered_json;
namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* k_case = R"lua(local p = args{ span = number{ 10, min = 6, max = 20, unit = m }, sweep = number{ 20, min = 0, max = 40, unit = deg } }
local function wings()
  local main = wing{ name = "wing", symmetric = true, position = { 3, 0, 0 }, sections = {
    { y = 0, chord = 2, airfoil = "naca0012" },
    { y = p.span/2, chord = 1, sweep = p.sweep } } }
  return main
end
local body = fuselage{ name = "body", frames = { { x = 1, diameter = 1 }, { x = 4, diameter = 1.2 }, { x = 8, diameter = 0.8 } }, nose_height = 0.6, tail_height = 0.5 }
local model = aircraft{ body, wings() }
print(model)
local surface = surface_mesh{ model, max_edge = 0.5 }
surface:write "workbench.stl"
)lua";

class WorkbenchTest : public testing::Test {
 protected:
  void SetUp() override {
    STERNA_NEEDS(!scripting::view_page().empty(), "the workbench's page (npm or its registry, when this was built)");
    fs::create_directories(folder_);
    write(k_case);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& text) const {
    std::ofstream(folder_ / "new.lua") << text;
    fs::rename(folder_ / "new.lua", folder_ / "case.lua");  // as editors save files
  }

  void start(std::vector<std::string> words) {
    words.insert(words.begin(), {sterna_program().string(), "view"});
    child_.emplace(ChildStart{.words = words, .descriptors = {}, .output = (folder_ / "said.txt").string(), .folder = folder_.string()});
    for (int i = 0; i < 600 && address_.empty(); ++i) {
      std::this_thread::sleep_for(50ms);
      std::ifstream said(folder_ / "said.txt");
      for (std::string line; std::getline(said, line);)
        if (line.starts_with("http://127.0.0.1:") && line.ends_with("/")) address_ = line;
    }
    ASSERT_FALSE(address_.empty());
    std::tie(port_, secret_) = parts_of(address_);
  }

  ViewJson state(std::uint64_t since = 0) const {
    return ViewJson::parse(body_of(exchange_bytes(port_, get_request(port_, secret_ + "state?since=" + std::to_string(since) + "&lines=0"))), nullptr, false);
  }
  int post(const std::string& name, const ViewJson& json) const { return status_of(exchange_bytes(port_, post_request(port_, secret_ + name, json.dump()))); }

  /// Returns the first state for which `is_so` is true; the last state after half a minute.
  template <class Test>
  ViewJson wait_for(const Test& is_so) const {
    ViewJson now;
    for (const auto end = std::chrono::steady_clock::now() + 60s; std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(20ms)) {
      now = state();
      if (now.is_object() && is_so(now)) return now;
    }
    ADD_FAILURE() << "waited in vain; the last state is " << now.dump();
    return now;
  }
  ViewJson wait_for_end(int after_run) const {
    return wait_for(
        [&](const ViewJson& now) { return now["run"]["number"] > after_run && (now["run"]["status"] == "done" || now["run"]["status"] == "failed"); });
  }
  static ViewJson object(const ViewJson& state, const std::string& key) {
    for (const ViewJson& entry : state["objects"])
      if (entry["key"] == key) return entry;
    return nullptr;
  }

  /// Returns the JSON of a scene, and the extent of its points along y.
  std::pair<ViewJson, double> scene(std::uint64_t number) const {
    const std::string bytes = body_of(exchange_bytes(port_, get_request(port_, secret_ + "scene?scene=" + std::to_string(number))));
    if (bytes.size() < 8) return {};
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data(), 4);
    ViewJson json = ViewJson::parse(bytes.substr(8, length));
    const ViewJson& points = json["surface"]["points"];
    std::vector<float> values(points["n"].get<std::size_t>());
    std::memcpy(values.data(), bytes.data() + 8 + length + points["at"].get<std::size_t>(), 4 * values.size());
    float low = 1e30f, high = -1e30f;
    for (std::size_t i = 1; i < values.size(); i += 3) {
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    return {json, high - low};
  }

  const fs::path folder_ = fs::temp_directory_path() / ("sterna_view_test_" + std::to_string(getpid()));
  std::optional<ChildProcess> child_;
  std::string address_, secret_;
  int port_ = 0;
};

TEST_F(WorkbenchTest, ShowsArgumentsOfScriptAndModulesInOrder) {
  std::ofstream(folder_ / "parts.lua") << "return args{ zeta = 1,\n  span = number{ 10, min = 6, max = 20 } }";
  write("local g = args{ level = 'coarse', depth = 3 }\nlocal m = require 'parts'\nlocal b = box{ {0,0,0}, {m.span,1,1} }");
  start({"case.lua", "--no-browser", "span=12"});
  const ViewJson now = wait_for_end(0);
  EXPECT_EQ(now["run"]["status"], "done") << now.dump();
  std::vector<std::string> names;
  for (const ViewJson& parameter : now["parameters"]) names.push_back(parameter["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"level", "depth", "zeta", "span"}));
  EXPECT_EQ(now["parameters"][3]["value"], 12);
  EXPECT_EQ(now["values"]["span"], "12");
}

TEST_F(WorkbenchTest, FollowsScriptFromFirstLineToMesh) {
  start({"case.lua", "--no-browser", "--threads", "2", "span=12"});
  EXPECT_TRUE(body_of(exchange_bytes(port_, get_request(port_, secret_))).starts_with("<!DOCTYPE html>"));

  // Mode "geometry": the model is shown under the name of its variable; nothing is meshed or written.
  ViewJson now = wait_for_end(0);
  EXPECT_EQ(now["run"]["status"], "done") << now.dump();
  EXPECT_EQ(now["run"]["mode"], "geometry");
  ViewJson model = object(now, "model");
  ASSERT_TRUE(model.is_object()) << now.dump();
  EXPECT_EQ(model["kind"], "model");
  EXPECT_EQ(model["line"], 9);
  EXPECT_EQ(model["is_shown"], true);
  EXPECT_EQ(object(now, "main")["kind"], "component");  // a local variable of a function
  EXPECT_EQ(object(now, "body")["is_shown"], false);
  EXPECT_FALSE(fs::exists(folder_ / "workbench.stl"));
  auto [shown, span] = scene(model["scene"]);
  EXPECT_EQ(shown["schema"], "sterna-scene-1");
  EXPECT_NEAR(span, 12.12, 0.02);  // with its round tips
  EXPECT_EQ(shown["is_quick"], false);
  ASSERT_EQ(now["parameters"].size(), 2u);
  EXPECT_EQ(now["parameters"][0]["name"], "span");
  EXPECT_EQ(now["parameters"][0]["max"], 20);
  EXPECT_EQ(now["parameters"][0]["value"], 12);
  EXPECT_NEAR(now["parameters"][1]["value"].get<double>(), 20.0, 1e-9);
  EXPECT_EQ(now["parameters"][1]["unit"], "deg");

  // An argument: a sketch while it is dragged, then the full model; beyond its limits an error, and the picture stays.
  EXPECT_EQ(post("values", {{"values", {{"span", "16"}}}, {"is_dragging", true}}), 200);
  now = wait_for([&](const ViewJson& s) { return s["run"]["mode"] == "sketch" && s["run"]["status"] == "done" && object(s, "model")["is_quick"] == true; });
  EXPECT_NEAR(scene(object(now, "model")["scene"]).second, 16.12, 0.02);
  EXPECT_EQ(post("values", {{"values", {{"span", "50"}}}}), 200);
  now = wait_for_end(now["run"]["number"]);
  EXPECT_EQ(now["run"]["status"], "failed");
  EXPECT_NE(now["problems"][0]["text"].get<std::string>().find("above the maximum, 20 m"), std::string::npos) << now["problems"].dump();
  EXPECT_EQ(now["problems"][0]["line"], 1);
  EXPECT_EQ(object(now, "model")["is_old"], true);
  EXPECT_EQ(post("values", {{"values", {{"span", "14"}}}}), 200);
  now = wait_for_end(now["run"]["number"]);
  EXPECT_EQ(now["run"]["status"], "done");

  // The value is written back to the script, which is run again.
  EXPECT_EQ(post("save", ViewJson::object()), 200);
  now = wait_for([&](const ViewJson& s) { return s["values"].empty() && s["run"]["status"] == "done" && s["run"]["number"] > now["run"]["number"]; });
  std::ifstream saved(folder_ / "case.lua");
  std::string first_line;
  std::getline(saved, first_line);
  EXPECT_NE(first_line.find("span = number{ 14, min = 6"), std::string::npos) << first_line;
  EXPECT_NEAR(scene(object(now, "model")["scene"]).second, 14.12, 0.02);

  // A line is broken, then repaired.
  std::string broken = k_case;
  broken.replace(broken.find("chord = 2"), 9, "cord = 2");
  write(broken);
  now = wait_for_end(now["run"]["number"]);
  EXPECT_EQ(now["run"]["status"], "failed");
  EXPECT_NE(now["problems"].dump().find("did you mean"), std::string::npos) << now["problems"].dump();
  EXPECT_EQ(now["problems"][0]["line"], 3) << now["problems"].dump();
  // Objects made by the script before the error are not shown automatically; the model shown before remains, marked as old.
  broken.replace(broken.find("local model"), 11, "local block = box{ { 0, 0, 0 }, { 1, 1, 1 } }\nlocal model");
  write(broken);
  now = wait_for_end(now["run"]["number"]);
  EXPECT_EQ(now["run"]["status"], "failed");
  ASSERT_TRUE(object(now, "block").is_object()) << now.dump();
  EXPECT_EQ(object(now, "block")["is_shown"], false);
  EXPECT_EQ(object(now, "model")["is_shown"], true);
  EXPECT_EQ(object(now, "model")["is_old"], true);
  write(k_case);
  now = wait_for_end(now["run"]["number"]);
  EXPECT_EQ(now["run"]["status"], "done");
  EXPECT_EQ(object(now, "model")["is_old"], false);

  // Mode "mesh": the whole script runs.
  EXPECT_EQ(post("run", {{"mode", "mesh"}}), 200);
  now = wait_for([&](const ViewJson& s) { return s["run"]["mode"] == "mesh" && s["run"]["status"] != "running"; });
  EXPECT_EQ(now["run"]["status"], "done") << now["problems"].dump();
  EXPECT_TRUE(fs::exists(folder_ / "workbench.stl"));
  const ViewJson surface = object(now, "surface");
  ASSERT_TRUE(surface.is_object());
  EXPECT_EQ(surface["is_shown"], true);
  EXPECT_GT(scene(surface["scene"]).first["surface"]["fields"].size(), 2u);

  // The findings of inspect{}; models are not inspected.
  const ViewJson found = ViewJson::parse(body_of(exchange_bytes(port_, post_request(port_, secret_ + "inspect", "{\"key\": \"surface\"}"))), nullptr, false);
  EXPECT_EQ(found.value("schema", ""), "sterna-inspect-1");
  EXPECT_EQ(found.value("ok", false), true) << found.dump();
  EXPECT_EQ(post("inspect", {{"key", "model"}}), 409);

  // Invalid requests are refused, and the program continues.
  EXPECT_EQ(post("run", {{"mode", "everything"}}), 400);
  EXPECT_EQ(post("show", {{"key", "nobody"}}), 404);
  EXPECT_EQ(post("nothing", ViewJson::object()), 404);
  EXPECT_EQ(post("cut", {{"key", "surface"}, {"plane", "x=1"}}), 409);
  EXPECT_EQ(status_of(exchange_bytes(port_, post_request(port_, secret_ + "values", "no json"))), 400);
  EXPECT_EQ(status_of(exchange_bytes(port_, post_request(port_, secret_ + "values", "{\"values\": {\"a b\": \"1\"}}"))), 409);
  EXPECT_EQ(status_of(exchange_bytes(port_, get_request(port_, secret_ + "scene?scene=99999"))), 410);

  // Ctrl-C ends the program and the processes that it started.
  const std::vector<pid_t> workers = children_of(first_child());
  EXPECT_FALSE(workers.empty());
  ::kill(first_child(), SIGINT);
  EXPECT_EQ(child_->wait(), 0);
  for (const pid_t worker : workers) EXPECT_NE(::kill(worker, 0), 0) << worker;
}

TEST_F(WorkbenchTest, ShowsFilesAndEndsRunsThatAreOvertaken) {
  std::ofstream(folder_ / "case.lua")
      << "local body = fuselage{ name = \"body\", frames = { { x = 1, diameter = 1 }, { x = 4, diameter = 1.2 } }, nose_height = 0.6 }\n"
         "surface_mesh{ aircraft{ body }, max_edge = 0.4 }:write \"body.stl\"\n";
  ASSERT_EQ(run_process(sterna_program(), {"run", "case.lua"}, folder_).status, 0);
  start({"body.stl", "--no-browser"});
  const ViewJson now = wait_for_end(0);
  EXPECT_EQ(now["has_script"], false);
  EXPECT_EQ(object(now, "surface")["kind"], "surface") << now.dump();
  EXPECT_EQ(post("save", ViewJson::object()), 409);
  child_.reset();
  address_.clear();

  write("while true do end\n");
  start({"case.lua", "--no-browser"});
  wait_for([](const ViewJson& s) { return s["run"]["status"] == "running"; });
  write(k_case);
  EXPECT_EQ(wait_for_end(1)["run"]["status"], "done");
  write("while true do end\n");
  wait_for([](const ViewJson& s) { return s["run"]["status"] == "running"; });
  EXPECT_EQ(post("stop", ViewJson::object()), 200);
  EXPECT_EQ(wait_for([](const ViewJson& s) { return s["run"]["status"] == "stopped"; })["run"]["status"], "stopped");
}

TEST_F(WorkbenchTest, GoesThroughTheCasesOfASeries) {
  std::ofstream(folder_ / "series.lua")
      << "series{ 'boxes', over = { height = { 1, 2, 3 } }, case = function(p)\n"
         "  if p.height == 2 then return 1 end\n"
         "  return volume_mesh{ surface_mesh{ box{ {0, 0, 0}, {1, 1, p.height} }, max_edge = 0.6 }, layers = 2, first_height = 0.02,\n"
         "    farfield = sphere{ radius = 10 } }:write(p.name .. '.su2') end }\n";
  ASSERT_EQ(run_process(sterna_program(), {"run", "series.lua"}, folder_).status, 0);
  start({"boxes", "--no-browser"});
  ViewJson now = wait_for_end(0);
  EXPECT_EQ(now["run"]["status"], "done") << now.dump();
  ASSERT_EQ(now["parameters"].size(), 1u);
  EXPECT_EQ(now["parameters"][0]["name"], "case");
  EXPECT_EQ(now["parameters"][0]["max"], 2);  // one of the three cases has no mesh
  EXPECT_NE(now["lines"].dump().find("case 1 of 2, height=1: VALID"), std::string::npos) << now["lines"].dump();
  EXPECT_EQ(object(now, "mesh")["kind"], "mesh");
  EXPECT_EQ(now["has_cases"], true);
  const ViewJson cases = ViewJson::parse(body_of(exchange_bytes(port_, get_request(port_, secret_ + "cases"))), nullptr, false);
  ASSERT_EQ(cases.size(), 3u) << cases.dump();
  EXPECT_EQ(cases[0]["case"], 1);
  EXPECT_EQ(cases[1]["case"], nullptr);  // the case without a mesh
  EXPECT_EQ(cases[2]["case"], 2);
  EXPECT_EQ(cases[2]["parameters"]["height"], 3);
  EXPECT_EQ(cases[2]["verdict"], "VALID");
  EXPECT_EQ(status_of(exchange_bytes(port_, get_request(port_, secret_ + "picture?picture=0"))), 404);  // no case has written one
  EXPECT_EQ(post("values", {{"values", {{"case", "2"}}}}), 200);
  now = wait_for_end(now["run"]["number"]);
  EXPECT_NE(now["lines"].dump().find("case 2 of 2, height=3: VALID"), std::string::npos) << now["lines"].dump();
  EXPECT_EQ(post("save", ViewJson::object()), 409);  // not a script of the user
}

TEST_F(WorkbenchTest, SaysWhatItCannotShow) {
  EXPECT_NE(run_process(sterna_program(), {"view", "nothing.lua", "--no-browser"}, folder_).errors.find("there is no such file"), std::string::npos);
  EXPECT_NE(run_process(sterna_program(), {"view", ".", "--no-browser"}, folder_).errors.find("not a series folder"), std::string::npos);
  EXPECT_EQ(run_process(sterna_program(), {"view", "case.lua", "--port", "99999"}, folder_).status, 2);
}

}  // namespace
}  // namespace sterna::test
