#include "tests/scripting/series/slurm_cluster.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace sterna::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds k_patience{60};  ///< time limit for a loaded machine; 4 s otherwise

fs::path program(const std::string& name) {
  for (const char* folder : {"/usr/sbin", "/usr/bin"})
    if (fs::exists(fs::path(folder) / name)) return fs::path(folder) / name;
  return {};
}

ProcessResult run(const std::string& name, const std::vector<std::string>& words, const fs::path& folder) { return run_process(program(name), words, folder); }

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  const std::string text = name.data();
  return text.substr(0, text.find('.'));
}

void own_folder(const fs::path& path, const passwd& user) {
  fs::create_directories(path);
  if (chown(path.c_str(), user.pw_uid, user.pw_gid) != 0) throw std::runtime_error("chown " + path.string());
}

fs::path temporary_folder() {
  std::string name = "/tmp/sterna_slurm_XXXXXX";
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  return name;
}

/// Returns the folders in /proc of all processes started with the configuration file of this cluster.
std::vector<fs::path> processes_of(const fs::path& conf) {
  const std::string setting = "SLURM_CONF=" + conf.string();
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/proc", ignored)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos || std::stoi(name) == getpid()) continue;
    if (contents(entry.path() / "environ").find(setting) != std::string::npos) found.push_back(entry.path());
  }
  return found;
}

/// Kills jobs that outlive their node.
void kill_jobs(const fs::path& conf) {
  for (const fs::path& process : processes_of(conf)) kill(std::stoi(process.filename()), SIGKILL);
}

/// Returns the last lines of a log.
std::string tail(const fs::path& path) {
  constexpr std::size_t k_letters = 4000;
  const std::string all = contents(path);
  return "---- " + path.filename().string() + "\n" + (all.size() > k_letters ? all.substr(all.size() - k_letters) : all);
}

/// Sends SIGTERM to a daemon and waits for its end, at most 10 s.
void end(StartedProcess& process) {
  process.signal(SIGTERM);
  for (const auto begin = Clock::now(); !process.has_ended() && Clock::now() - begin < std::chrono::seconds(10);)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace

bool SlurmCluster::is_possible() {
  for (const char* name : {"munged", "munge", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scontrol"})
    if (program(name).empty()) return false;
  return geteuid() == 0;
}

SlurmCluster::SlurmCluster() : folder_(temporary_folder()) {
  try {
    start_munge();
    write_conf();
    setenv("SLURM_CONF", (folder_ / "slurm.conf").c_str(), 1);
    // In the foreground (-D), so that they are children of this process and end with it.
    start_controller();
    node_ = std::make_unique<StartedProcess>(program("slurmd"), std::vector<std::string>{"-D", "-f", (folder_ / "slurm.conf").string()}, folder_);
    wait_until_idle();
  } catch (...) {
    stop();
    throw;
  }
}

SlurmCluster::~SlurmCluster() { stop(); }

void SlurmCluster::start_controller() {
  controller_ = std::make_unique<StartedProcess>(program("slurmctld"), std::vector<std::string>{"-D", "-f", conf().string()}, folder_);
}

std::string SlurmCluster::set_node(const std::string& state) const {
  return run("scontrol", {"update", "nodename=" + host_name(), "state=" + state, "reason=test"}, folder_).errors;
}

void SlurmCluster::take_node_down() const {
  // A controller that has just restarted may not have registered the node yet.
  std::string errors;
  for (const auto begin = Clock::now(); !(errors = set_node("down")).empty();) {
    if (Clock::now() - begin > k_patience) throw std::runtime_error("scontrol: " + errors);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

void SlurmCluster::bring_node_back() const {
  // If the node is already back, because its daemon has contacted the controller (ReturnToService), scontrol refuses to resume it.
  const std::string errors = set_node("resume");
  if (!errors.empty() && errors.find("Invalid node state") == std::string::npos) throw std::runtime_error("scontrol: " + errors);
}

void SlurmCluster::kill_controller() {
  constexpr std::chrono::seconds k_saved{7};  // the controller saves its state every five seconds and restarts jobs that are not in the saved state
  std::this_thread::sleep_for(k_saved);
  controller_->signal(SIGKILL);
  controller_->wait();
}

void SlurmCluster::restart_controller() {
  start_controller();
  for (const auto begin = Clock::now(); run("squeue", {"--noheader"}, folder_).status != 0;) {  // the node may be busy
    if (Clock::now() - begin > k_patience) throw std::runtime_error("the controller does not come back:\n" + contents(folder_ / "ctld.log"));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

std::string SlurmCluster::queue() const { return run("squeue", {"--noheader"}, folder_).output; }

std::string SlurmCluster::running_cases() const {
  std::string text;
  std::error_code ignored;
  for (const fs::path& process : processes_of(conf())) {
    std::string words = contents(process / "cmdline");
    std::ranges::replace(words, '\0', ' ');
    if (words.find("--series-case") == std::string::npos) continue;
    text += process.filename().string() + ": " + words + "\n";
    for (const auto& thread : fs::directory_iterator(process / "task", ignored)) {
      const std::string status = contents(thread.path() / "status"), state = status.substr(std::min(status.find("State:"), status.size()));
      text += "  thread " + thread.path().filename().string() + " " + state.substr(0, state.find('\n')) + ", waits in " + contents(thread.path() / "wchan") +
              ", system call " + contents(thread.path() / "syscall");
    }
  }
  return text;
}

std::string SlurmCluster::account() const {
  return run("scontrol", {"show", "job"}, folder_).output + run("scontrol", {"show", "node"}, folder_).output + tail(folder_ / "ctld.log") +
         tail(folder_ / "d.log");
}

void SlurmCluster::start_munge() {
  if (run("munge", {"-n"}, folder_).status == 0) return;  // the machine already runs one
  const passwd* user = getpwnam("munge");
  if (!user) throw std::runtime_error("there is no user munge");
  for (const char* path : {"/run/munge", "/var/log/munge", "/var/lib/munge", "/etc/munge"}) own_folder(path, *user);
  if (!fs::exists("/etc/munge/munge.key")) {
    if (run("mungekey", {"--create"}, folder_).status != 0) throw std::runtime_error("no key for munge");
    own_folder("/etc/munge", *user);
  }
  munge_ = std::make_unique<StartedProcess>(program("runuser"),
                                            std::vector<std::string>{"-u", "munge", "--", program("munged").string(), "--foreground", "--force"}, folder_);
  for (const auto begin = Clock::now(); run("munge", {"-n"}, folder_).status != 0;) {
    if (Clock::now() - begin > k_patience || munge_->has_ended()) throw std::runtime_error("munged does not come up: " + contents("/var/log/munge/munged.log"));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

void SlurmCluster::write_conf() {
  const std::string host = host_name(), f = folder_.string();
  const int port = 20000 + 2 * (getpid() % 10000);  // another Slurm on this machine uses the standard ports
  fs::create_directories(folder_ / "ctld");
  fs::create_directories(folder_ / "d");
  std::ofstream(folder_ / "slurm.conf") << "ClusterName=test\nSlurmctldHost=" << host << "(127.0.0.1)\nSlurmctldPort=" << port << "\nSlurmdPort=" << port + 1
                                        << "\nSlurmUser=root\nAuthType=auth/munge\nStateSaveLocation=" << f << "/ctld\nSlurmdSpoolDir=" << f
                                        << "/d\nSlurmctldPidFile=" << f << "/ctld.pid\nSlurmdPidFile=" << f << "/d.pid\nSlurmctldLogFile=" << f
                                        << "/ctld.log\nSlurmdLogFile=" << f
                                        << "/d.log\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSchedulerType=sched/backfill\nSelectType=select/"
                                           "cons_tres\nSelectTypeParameters=CR_CPU\n"
                                           "ReturnToService=2\nMpiDefault=none\nNodeName="
                                        << host << " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\nPartitionName=cfd Nodes=" << host
                                        << " Default=YES MaxTime=INFINITE State=UP\n";
}

void SlurmCluster::wait_until_idle() {
  for (const auto begin = Clock::now(); run("sinfo", {"--noheader", "--format=%T"}, folder_).output.find("idle") == std::string::npos;) {
    if (Clock::now() - begin > k_patience || controller_->has_ended() || node_->has_ended())
      throw std::runtime_error("Slurm does not come up:\n" + contents(folder_ / "ctld.log") + contents(folder_ / "d.log"));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

void SlurmCluster::stop() noexcept {
  if (node_) end(*node_);
  if (controller_) end(*controller_);
  if (munge_) end(*munge_);
  try {
    kill_jobs(conf());
  } catch (...) {  // for example out of memory: nothing more can be done
  }
  unsetenv("SLURM_CONF");
  std::error_code ignored;  // files left in /tmp do no harm
  fs::remove_all(folder_, ignored);
}

}  // namespace sterna::test
