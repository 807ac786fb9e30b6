// A real Slurm on this machine for as long as a test needs it: controller and one node on 127.0.0.1, without systemd, as root.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/process.h"

namespace sterna::test {

/// Sets SLURM_CONF for this process and all that it starts. All daemons end with the object.
class SlurmCluster {
 public:
  /// Whether all is installed and this is root.
  static bool is_possible();
  /// \throws std::runtime_error with the daemons' words when it does not come up
  SlurmCluster();
  ~SlurmCluster();
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// What squeue says of all jobs; empty once there is none.
  std::string queue() const;
  /// What jobs of cases that still run are doing (state, system call, threads of each); empty where none runs, whatever the queue says.
  std::string running_cases() const;
  /// For a message: what the daemons know and have written.
  std::string account() const;
  std::filesystem::path conf() const { return folder_ / "slurm.conf"; }
  /// The node fails: what runs there is lost, and nothing starts until it is back. \throws std::runtime_error where scontrol refuses for a minute
  void take_node_down() const;
  void bring_node_back() const;
  /// The controller is killed, and comes back with what it has saved.
  void kill_controller();
  void restart_controller();

 private:
  void start_munge();
  void write_conf();
  void start_controller();
  std::string set_node(const std::string& state) const;  ///< what scontrol says against it
  void wait_until_idle();
  void stop() noexcept;

  std::filesystem::path folder_;  ///< in /tmp: it holds sockets, whose names may have 107 letters
  std::unique_ptr<StartedProcess> munge_, controller_, node_;
};

}  // namespace sterna::test
