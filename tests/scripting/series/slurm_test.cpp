// The wind-tunnel series on a real Slurm that the test starts on this machine, two jobs at a time.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/scripting/series/series_fixture.h"
#include "tests/scripting/series/slurm_cluster.h"
#include "tests/scripting/series/tunnel_series.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

class SlurmSeries : public SeriesFixture {
 protected:
  static void wait_for_empty_queue(const test::SlurmCluster& cluster) {
    for (int i = 0; i < 3000 && !cluster.queue().empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(cluster.queue(), "") << cluster.running_cases() << cluster.account();
  }
  bool wait_for(const std::string& file, const std::string& text) const {
    for (int i = 0; i < 1500; ++i) {
      if (text_of(file).find(text) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }
  /// Returns the last part of the folder name of the first case in a job script.
  std::string first_folder_of(const std::string& script) const {
    const std::string text = text_of(script), before = "folder='";
    const std::size_t begin = text.find(before) + before.size();
    return std::filesystem::path(text.substr(begin, text.find('\'', begin) - begin)).filename();
  }
  /// Returns meshes, manifests and quality of all cases, and the table.
  std::map<std::string, std::string> results() const {
    auto files = snapshot(folder_ / "polar");
    std::erase_if(files, [](const auto& file) {
      return file.first.find("/script/") != std::string::npos || file.first.ends_with("case.json") || file.first.ends_with("status.json");
    });
    return files;
  }
};

// A single test, because Slurm takes seconds to start.
TEST_F(SlurmSeries, RunsAsJobsIsCancelledSurvivesLostJobs) {
  STERNA_NEEDS_SHARED_DATA();
  STERNA_NEEDS(test::SlurmCluster::is_possible(), "slurm-wlm with munge, or the right to start it,");
  test::SlurmCluster cluster;

  // The whole series: the same bytes as with a local pool of workers.
  const test::ProcessResult jobs =
      run(tunnel_series("run = slurm{ partition = 'cfd', tasks = 2, time = '00:20:00', options = { comment = 'a test', nice = 10 } },"));
  EXPECT_EQ(jobs.status, 1) << jobs.errors;
  EXPECT_THAT(jobs.output, HasSubstr("12\t2\t0"));
  EXPECT_THAT(text_of("polar/slurm/array-1.sh"), HasSubstr("#SBATCH --array=1-14%2\n"));
  const auto of_slurm = results();

  // A controller that has lost some seconds restarts a job that has already finished; the job leaves the case unchanged.
  const std::string log = "polar/" + first_folder_of("polar/slurm/array-1.sh") + "/log.txt", said = text_of(log);
  test::run_process("/usr/bin/env", {"SLURM_ARRAY_TASK_ID=1", "/bin/sh", "polar/slurm/array-1.sh"}, folder_);
  EXPECT_EQ(difference(of_slurm, results()), "");
  EXPECT_TRUE(text_of(log).starts_with(said));
  EXPECT_THAT(text_of(log), HasSubstr("is complete already"));

  std::filesystem::remove_all(folder_ / "polar");
  run(tunnel_series("run = jobs{ 2, threads = 1 },"));
  EXPECT_EQ(difference(of_slurm, results()), "");

  // A killed job is reported; the other jobs continue, and a second run makes only the missing cases.
  const std::string script = R"lua(
series{ "s", over = { x = {1, 2, 3} }, run = slurm{ tasks = 2 }, case = function(p)
  local wall = p.x == 2 and pcall(read_surface, "go.stl")
  if p.x == 2 and not wall then while true do end end
end }
)lua";
  write(script, folder_);
  {
    test::StartedProcess main(test::sterna_program(), {"run", "case.lua"}, folder_);
    ASSERT_TRUE(wait_for("s/x=2/status.json", "\"pid\""));
    const std::string status = text_of("s/x=2/status.json");
    kill(std::stoi(status.substr(status.find("\"pid\": ") + 7)), SIGKILL);
    EXPECT_EQ(main.wait(), 1);
    EXPECT_THAT(text_of("s/x=2/status.json"), HasSubstr("is no longer in the queue and left no result"));
    EXPECT_THAT(text_of("s/x=3/status.json"), HasSubstr("done"));
  }
  wait_for_empty_queue(cluster);

  // A failing node loses its jobs; the absence of the controller is reported, and the run waits for it.
  {
    std::filesystem::remove(folder_ / "s/x=2/status.json");
    test::StartedProcess main(test::sterna_program(), {"run", "case.lua"}, folder_);
    ASSERT_TRUE(wait_for("s/x=2/status.json", "\"pid\""));
    cluster.kill_controller();
    std::this_thread::sleep_for(std::chrono::seconds(3));
    EXPECT_FALSE(main.has_ended());
    cluster.restart_controller();
    EXPECT_THAT(text_of("s/x=2/status.json"), HasSubstr("running"));
    cluster.take_node_down();
    EXPECT_EQ(main.wait(), 1);
    // Slurm may still send the job a signal to end; the job then reports this itself.
    EXPECT_THAT(text_of("s/x=2/status.json"),
                AllOf(HasSubstr("\"status\": \"killed\""), AnyOf(HasSubstr("is no longer in the queue"), HasSubstr("stopped on request"))));
    cluster.bring_node_back();
  }
  wait_for_empty_queue(cluster);

  // Ctrl-C removes the jobs from the queue. A killed main process leaves them there, and the next run removes them.
  for (const int signal : {SIGINT, SIGKILL}) {
    std::filesystem::remove(folder_ / "s/x=2/status.json");  // the previous one also contains "running"
    test::StartedProcess main(test::sterna_program(), {"run", "case.lua"}, folder_);
    ASSERT_TRUE(wait_for("s/x=2/status.json", "running"));
    const auto begin = std::chrono::steady_clock::now();
    main.signal(signal);
    main.wait();
    if (signal != SIGINT) continue;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 2.0);
    wait_for_empty_queue(cluster);
  }
  std::this_thread::sleep_for(std::chrono::seconds(3));  // "running" is reported before the case checks for this file; on a busy machine the case would
                                                         // otherwise find the file
  std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "go.stl");
  const test::ProcessResult last = run(script);
  EXPECT_EQ(last.status, 0) << last.errors;
  EXPECT_THAT(last.errors, HasSubstr("is still in the queue and will be cancelled"));
  EXPECT_THAT(last.errors, HasSubstr("x=1: done, from an earlier run"));
  wait_for_empty_queue(cluster);
}

}  // namespace
}  // namespace sterna::scripting
